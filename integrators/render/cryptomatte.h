// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "integrators/render/first_hit.h"
#include "scene/names.h"
#include "vernier/image.h"

// Mattes by name, with partial coverage at edges, as Cryptomatte stores them (Friedman and Jones 2015, "Fully
// automatic ID mattes with support for motion blur and transparency", SIGGRAPH talks; Psyop's specification
// 1.2): pairs of an id and its part of the pixel, the largest part first.

namespace vernier {

/// Names and ids that a pixel can have.
constexpr int cryptomatte_ranks = 6;

/// Of a name: its MurmurHash3 of 32 bits, seed 0, one bit flipped where the same bits as a float were not a
/// normal number.
uint32_t cryptomatte_hash(std::string_view name);

/// The ids of a scene's names, as float bits.
class CryptomatteIds {
 public:
  CryptomatteIds() = default;
  /// `names` must live as long.
  explicit CryptomatteIds(const SceneNames& names);

  /// The ranks of a pixel by one kind of name: id and part of the samples in turn, zeros at the end. What
  /// meets nothing has no name; ranks beyond the last are dropped.
  void write(const MetInstances& met, uint32_t SceneNames::Instance::*kind, float* channels) const;

  /// What a file's header says of the layer whose channels are called LAYER00.r and so on, of which
  /// `channels` are all: the manifest names what is in the picture.
  Metadata metadata(std::string_view layer, const Image& picture, int first_channel) const;

 private:
  const SceneNames* names_ = nullptr;
  std::vector<float> ids_;  ///< by name
};

}  // namespace vernier
