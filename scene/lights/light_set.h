// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "core/sampling/distribution.h"
#include "scene/lights/light.h"
#include "scene/lights/light_tree.h"

namespace vernier {

/// All lights of a scene, and the choice among them. Those with a place are chosen by a tree that knows where
/// they are, those at infinity in proportion to their irradiance, and between the two the irradiances decide
/// that they may cause at the receiver.
class LightSet {
 public:
  LightSet() = default;
  /// A light of no power is never chosen.
  explicit LightSet(std::vector<std::unique_ptr<Light>> lights);

  /// Gives the lights back, in the order they came.
  std::vector<std::unique_ptr<Light>> release() && { return std::move(lights_); }

  struct Choice {
    const Light* light = nullptr;
    float prob = 0;
  };
  /// A light that may shine on the receiver; null when there is none. u in [0, 1).
  Choice choose(const LightReceiver& receiver, double u) const;
  /// Probability that choose() picks light i.
  float prob(const LightReceiver& receiver, size_t i) const;

  /// Those that no ray meets: punctual ones.
  const std::vector<const Light*>& delta_lights() const { return delta_lights_; }

  size_t size() const { return lights_.size(); }
  const Light& operator[](size_t i) const { return *lights_[i]; }

 private:
  /// Probability that the tree chooses, by what its root may send to the receiver.
  double finite_share(const LightTree::Weights& root) const;

  std::vector<std::unique_ptr<Light>> lights_;
  std::vector<const Light*> delta_lights_;
  bool is_single_ = false;  ///< there is one light, and nothing to choose
  std::vector<const Light*> infinite_lights_;
  AliasTable infinite_;                 ///< over infinite_lights_, by irradiance
  std::vector<int32_t> infinite_slot_;  ///< by light: index in infinite_lights_, or -1
  LightTree tree_;                      ///< over all others
};

}  // namespace vernier
