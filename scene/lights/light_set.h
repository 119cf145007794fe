#pragma once

#include <memory>
#include <vector>

#include "core/sampling/distribution.h"
#include "scene/lights/light.h"

namespace vernier {

/// All lights of a scene, and the choice among them in proportion to power.
class LightSet {
 public:
  LightSet() = default;
  /// A light of no power is never chosen.
  LightSet(std::vector<std::unique_ptr<Light>> lights, const Bounds& scene);

  struct Choice {
    const Light* light = nullptr;
    float prob = 0;
  };
  /// A light that may shine on `from`; null when there is none. u in [0, 1).
  Choice choose(const SurfacePoint& from, float u) const;
  /// Probability that choose() picks light i at `from`.
  float prob(const SurfacePoint& from, size_t i) const;

  /// Those that no ray meets: punctual ones.
  const std::vector<const Light*>& delta_lights() const { return delta_lights_; }

  size_t size() const { return lights_.size(); }
  const Light& operator[](size_t i) const { return *lights_[i]; }

 private:
  std::vector<std::unique_ptr<Light>> lights_;
  std::vector<const Light*> delta_lights_;
  AliasTable by_power_;
};

}  // namespace vernier
