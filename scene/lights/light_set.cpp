#include "scene/lights/light_set.h"

namespace vernier {

LightSet::LightSet(std::vector<std::unique_ptr<Light>> lights, const Bounds& scene)
    : lights_(std::move(lights)), place_(lights_.size(), -1) {
  std::vector<LightBounds> bounds(lights_.size());  // of no power: not in the tree
  size_t placed = 0;
  for (size_t i = 0; i < lights_.size(); ++i) {
    if (lights_[i]->is_delta()) delta_lights_.push_back(lights_[i].get());
    if (const auto b = lights_[i]->bounds()) {
      bounds[i] = *b;
      ++placed;
    }
  }
  const bool use_tree = placed >= tree_threshold;
  std::vector<float> powers;
  float tree_power = 0;
  for (size_t i = 0; i < lights_.size(); ++i) {
    const float power = lights_[i]->power(scene);
    if (use_tree && lights_[i]->bounds()) {
      tree_power += power;
      continue;
    }
    place_[i] = int32_t(listed_.size());
    listed_.push_back(uint32_t(i));
    powers.push_back(power);
  }
  if (use_tree) {
    tree_.emplace(bounds);
    powers.push_back(tree_power);
  }
  by_power_ = AliasTable(powers);
}

LightSet::Choice LightSet::choose(const LightReceiver& receiver, float u) const {
  if (by_power_.empty()) return {};
  if (!tree_) {
    const size_t i = by_power_.sample(u);
    return {lights_[listed_[i]].get(), by_power_.prob(i)};
  }
  // The tree's share of u is stretched to choose within it.
  const float tree_prob = by_power_.prob(listed_.size());
  if (u < tree_prob) {
    const auto [light, prob] = tree_->sample(receiver, std::min(u / tree_prob, 0x1.fffffep-1f));
    if (!(prob > 0)) return {};
    return {lights_[light].get(), prob * tree_prob};
  }
  float rest = (u - tree_prob);
  for (size_t i = 0; i < listed_.size(); ++i) {
    const float prob = by_power_.prob(i);
    if (rest < prob) return {lights_[listed_[i]].get(), prob};
    rest -= prob;
  }
  return {};
}

float LightSet::prob(const LightReceiver& receiver, size_t i) const {
  if (by_power_.empty()) return 0;
  if (place_[i] >= 0) return by_power_.prob(size_t(place_[i]));
  return by_power_.prob(listed_.size()) * tree_->prob(receiver, uint32_t(i));
}

}  // namespace vernier
