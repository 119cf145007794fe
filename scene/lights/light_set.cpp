// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/light_set.h"

#include <iterator>

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

LightSet::LightSet(TriangleLights triangles, std::vector<std::unique_ptr<PunctualLight>> lamps)
    : triangles_(std::move(triangles)) {
  std::move(lamps.begin(), lamps.end(), std::back_inserter(others_));
  for (const auto& light : others_)
    if (light->is_delta()) delta_lights_.push_back(light.get());
  tree_ = LightTree(size(), [this](size_t i) {
    return (*this)[i].bounds().value_or(LightBounds{});  // of no power: not in the tree
  });
  collect_infinite();
}

void LightSet::set_environment(std::unique_ptr<Light> environment) {
  if (has_environment_) others_.pop_back();
  has_environment_ = environment != nullptr;
  if (environment) others_.push_back(std::move(environment));
  collect_infinite();
}

void LightSet::collect_infinite() {
  infinite_lights_.clear();
  infinite_slot_.assign(others_.size(), -1);
  std::vector<float> irradiances;
  for (size_t i = 0; i < others_.size(); ++i) {
    if (others_[i]->bounds()) continue;
    infinite_slot_[i] = int32_t(infinite_lights_.size());
    infinite_lights_.push_back(others_[i].get());
    irradiances.push_back(irradiance(*others_[i]));
  }
  infinite_ = AliasTable(irradiances);
  const bool is_infinite = !irradiances.empty();
  is_single_ = size() == 1 && (is_infinite ? irradiances[0] > 0 : (*this)[0].power({}) > 0);
}

double LightSet::finite_share(const LightTree::Weights& weights) const {
  if (infinite_.empty()) return 1;
  if (!(weights.sum > 0)) return 0;
  const double nearby = tree_.irradiance(weights);
  return std::clamp(nearby / (nearby + infinite_.sum()), least_share, 1 - least_share);
}

LightSet::Choice LightSet::choose(const LightReceiver& receiver, double u) const {
  if (is_single_) return {&(*this)[0], 1};
  const LightTree::Weights weights = tree_.weigh(receiver);
  // Each side's part of u is stretched to choose within it.
  const double share = finite_share(weights);
  if (u < share) {
    const auto [light, prob] = tree_.sample(receiver, weights, u / share);
    return prob > 0 ? Choice{&(*this)[light], float(prob * share)} : Choice{};
  }
  if (infinite_.empty()) return {};
  const size_t i = infinite_.sample((u - share) / (1 - share));
  return {infinite_lights_[i], float(infinite_.prob(i) * (1 - share))};
}

float LightSet::prob(const LightReceiver& receiver, size_t i) const {
  if (is_single_) return 1;
  const LightTree::Weights weights = tree_.weigh(receiver);
  const double share = finite_share(weights);
  const size_t triangles = triangles_.lights.size();
  if (const int32_t slot = i < triangles ? -1 : infinite_slot_[i - triangles]; slot >= 0)
    return infinite_.empty() ? 0 : float(infinite_.prob(size_t(slot)) * (1 - share));
  return float(tree_.prob(receiver, weights, uint32_t(i)) * share);
}

}  // namespace vernier
