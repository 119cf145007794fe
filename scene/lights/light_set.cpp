#include "scene/lights/light_set.h"

namespace vernier {

LightSet::LightSet(std::vector<std::unique_ptr<Light>> lights, const Bounds& scene)
    : lights_(std::move(lights)) {
  std::vector<float> powers;
  for (const auto& light : lights_) {
    powers.push_back(light->power(scene));
    if (light->is_delta()) delta_lights_.push_back(light.get());
  }
  by_power_ = AliasTable(powers);
}

LightSet::Choice LightSet::choose(const SurfacePoint& /*from*/, float u) const {
  if (by_power_.empty()) return {};
  const size_t i = by_power_.sample(u);
  return {lights_[i].get(), by_power_.prob(i)};
}

float LightSet::prob(const SurfacePoint& /*from*/, size_t i) const {
  return by_power_.empty() ? 0 : by_power_.prob(i);
}

}  // namespace vernier
