// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/film/gradient_film.h"
#include "integrators/render/layers.h"
#include "integrators/render/render.h"
#include "integrators/render/settings_identity.h"
#include "vernier/image.h"

namespace vernier {

/// Renders of one picture by different seeds, put together from their checkpoints one after the other: memory
/// does not depend on how many there are.
class Merged {
 public:
  /// Throws Error(input) when the file is no checkpoint, is of another picture than those before, or has the
  /// seed of one of them.
  void add(const std::string& path);

  /// Of all samples, with their error and what they are known to leave out. One file or more was added.
  RenderResult& result();
  /// With those layers, and texts that say what was sampled, by which seeds, and how wrong it is; after
  /// result().
  LayeredImage picture(std::span<const Layer> layers) const;

 private:
  Metadata metadata() const;

  std::optional<RenderResult> result_;
  RenderIdentity identity_;  ///< without seed, build and platform
  std::vector<TileLight> light_;
  GradientFilm gradients_;  ///< empty where the integrator estimates none
  std::map<uint64_t, std::string> files_by_seed_;
};

}  // namespace vernier
