// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vernier/scene.h"

namespace vernier {

/// What the things of a scene are called, for layers and groups of lights that ask for them by name. What has
/// no name in the scene gets one by its number: "object 3".
class SceneNames {
 public:
  /// Indices into texts().
  struct Instance {
    uint32_t object = 0, material = 0, asset = 0;
  };

  SceneNames() = default;
  explicit SceneNames(const SceneDescription& description);

  /// All names, each once.
  const std::vector<std::string>& texts() const { return texts_; }
  const Instance& of(uint32_t instance) const { return instances_[instance]; }
  size_t instance_count() const { return instances_.size(); }
  /// Of the punctual lights, in their order.
  const std::vector<std::string>& lamps() const { return lamps_; }

 private:
  std::vector<std::string> texts_;
  std::vector<Instance> instances_;
  std::vector<std::string> lamps_;
};

}  // namespace vernier
