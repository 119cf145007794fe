// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/light_set.h"

namespace vernier {
namespace {

/// Part of the samples that lights at infinity get at least where nearby ones may contribute too, and that
/// these get at least: either may be hidden, of which no estimate knows.
constexpr double least_share = 1 / 8.0;

/// Of a surface that a light at infinity shines on straight; of a sky, the mean of all that may face it.
float irradiance(const Light& light) {
  Bounds disk;
  disk.add(Vec3f(-1, 0, 0));
  disk.add(Vec3f(1, 0, 0));
  return std::min(light.power(disk), std::numeric_limits<float>::max()) * inv_pi;
}

}  // namespace

LightSet::LightSet(std::vector<std::unique_ptr<Light>> lights)
    : lights_(std::move(lights)), infinite_slot_(lights_.size(), -1) {
  std::vector<LightBounds> bounds(lights_.size());  // of no power: not in the tree
  std::vector<float> irradiances;
  for (size_t i = 0; i < lights_.size(); ++i) {
    if (lights_[i]->is_delta()) delta_lights_.push_back(lights_[i].get());
    if (const auto b = lights_[i]->bounds()) {
      bounds[i] = *b;
      continue;
    }
    infinite_slot_[i] = int32_t(infinite_lights_.size());
    infinite_lights_.push_back(lights_[i].get());
    irradiances.push_back(irradiance(*lights_[i]));
  }
  is_single_ = lights_.size() == 1 && (bounds[0].power > 0 || (!irradiances.empty() && irradiances[0] > 0));
  infinite_ = AliasTable(irradiances);
  tree_ = LightTree(std::move(bounds));
}

double LightSet::finite_share(const LightTree::Weights& weights) const {
  if (infinite_.empty()) return 1;
  if (!(weights.sum > 0)) return 0;
  const double nearby = tree_.irradiance(weights);
  return std::clamp(nearby / (nearby + infinite_.sum()), least_share, 1 - least_share);
}

LightSet::Choice LightSet::choose(const LightReceiver& receiver, double u) const {
  if (is_single_) return {lights_[0].get(), 1};
  const LightTree::Weights weights = tree_.weigh(receiver);
  // Each side's part of u is stretched to choose within it.
  const double share = finite_share(weights);
  if (u < share) {
    const auto [light, prob] = tree_.sample(receiver, weights, u / share);
    return prob > 0 ? Choice{lights_[light].get(), float(prob * share)} : Choice{};
  }
  if (infinite_.empty()) return {};
  const size_t i = infinite_.sample((u - share) / (1 - share));
  return {infinite_lights_[i], float(infinite_.prob(i) * (1 - share))};
}

float LightSet::prob(const LightReceiver& receiver, size_t i) const {
  if (is_single_) return 1;
  const LightTree::Weights weights = tree_.weigh(receiver);
  const double share = finite_share(weights);
  if (infinite_slot_[i] >= 0)
    return infinite_.empty() ? 0 : float(infinite_.prob(size_t(infinite_slot_[i])) * (1 - share));
  return float(tree_.prob(receiver, weights, uint32_t(i)) * share);
}

}  // namespace vernier
