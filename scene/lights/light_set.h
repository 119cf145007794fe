#pragma once

#include <memory>
#include <vector>

#include "core/sampling/distribution.h"
#include "scene/lights/light.h"
#include "scene/lights/light_tree.h"

namespace vernier {

/// All lights of a scene, and the choice among them: lights at infinity, and all others together, in
/// proportion to power; those with a place by a tree that knows where they are.
class LightSet {
 public:
  LightSet() = default;
  /// A light of no power is never chosen.
  LightSet(std::vector<std::unique_ptr<Light>> lights, const Bounds& scene);

  /// Gives the lights back, in the order they came.
  std::vector<std::unique_ptr<Light>> release() && { return std::move(lights_); }

  struct Choice {
    const Light* light = nullptr;
    float prob = 0;
  };
  /// A light that may shine on the receiver; null when there is none. u in [0, 1).
  Choice choose(const LightReceiver& receiver, float u) const;
  /// Probability that choose() picks light i.
  float prob(const LightReceiver& receiver, size_t i) const;

  /// Those that no ray meets: punctual ones.
  const std::vector<const Light*>& delta_lights() const { return delta_lights_; }

  size_t size() const { return lights_.size(); }
  const Light& operator[](size_t i) const { return *lights_[i]; }

 private:
  /// With so many lights that have a place there is something to choose.
  static constexpr size_t tree_threshold = 2;

  std::vector<std::unique_ptr<Light>> lights_;
  std::vector<const Light*> delta_lights_;
  /// By power; with a tree, over the lights at infinity and, last, the tree as a whole.
  AliasTable by_power_;
  std::vector<uint32_t> listed_;  ///< lights of by_power_
  std::vector<int32_t> place_;    ///< by light: index in by_power_, or -1 when it is in the tree
  std::optional<LightTree> tree_;
};

}  // namespace vernier
