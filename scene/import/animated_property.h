// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/import/animation_track.h"
#include "scene/import/document.h"
#include "vernier/scene.h"

namespace vernier {

/// A property that animations may set (glTF 2.0 Asset Object Model).
struct AnimatedProperty {
  std::string_view pattern;  ///< JSON pointer; {} stands for an index
  size_t width = 1;          ///< of a value; 0: as many as there are morph targets
  double lower = std::numeric_limits<float>::lowest(), upper = std::numeric_limits<float>::max();
  Blend blend = Blend::linear;
};

/// What a channel of an animation sets.
struct AnimationTarget {
  std::string pointer;  ///< JSON pointer of the property in the file
  const AnimatedProperty* property = nullptr;
  std::vector<size_t> indices;  ///< what stands for each {} of the pattern

  bool is(std::string_view pattern) const { return property->pattern == pattern; }
};

/// The JSON pointer that a channel aims at, by the node and path of glTF or by KHR_animation_pointer; empty:
/// none.
std::string channel_pointer(const tinygltf::AnimationChannel& channel);

/// None when the pointer names nothing that the file has and that may be animated.
std::optional<AnimationTarget> find_target(const Document& document, const std::string& pointer);

/// Tells in the use of KHR_animation_pointer which pointers of the file are not honoured.
void note_unknown_pointers(const Document& document, std::vector<FeatureUse>& features);

}  // namespace vernier
