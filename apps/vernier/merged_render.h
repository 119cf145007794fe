// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image_io.h"
#include "integrators/render/checkpoint.h"

namespace vernier::apps {

/// Renders of one picture by different seeds, put together one after the other: memory does not depend on how
/// many there are.
class MergedRender {
 public:
  /// Adds the samples of a checkpoint. Throws Error(input) when it is of another picture or has the seed of
  /// one before.
  void add(const std::string& path);

  /// All samples, with their error and what they are known to leave out. At least one render must have been
  /// added.
  const RenderResult& finish();

  /// Header entries that say how the picture came about.
  Metadata metadata(const std::string& command_line) const;

 private:
  void claim_seed(const std::string& path, RenderIdentity& identity);

  std::optional<RenderResult> result_;
  RenderIdentity identity_;  ///< without seed, build and platform
  std::vector<TileLight> light_;
  std::map<uint64_t, std::string> files_by_seed_;
};

}  // namespace vernier::apps
