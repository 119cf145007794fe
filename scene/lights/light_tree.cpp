// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/light_tree.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "scene/lights/light_tree_builder.h"

namespace vernier {
namespace {

double sum(const Float8& x) {
  return ((double(x[0]) + x[1]) + (double(x[2]) + x[3])) + ((double(x[4]) + x[5]) + (double(x[6]) + x[7]));
}

}  // namespace

LightTree::LightTree(size_t count, const std::function<LightBounds(size_t)>& bounds_of)
    : places_(count, nowhere) {
  std::vector<PlacedLight> lights(count);
  parallel_for(count, [&](size_t i) { lights[i] = {bounds_of(i), uint32_t(i)}; });
  std::erase_if(lights, [](const PlacedLight& light) { return !(light.bounds.power > 0); });
  for (PlacedLight& light : lights) {
    light.bounds.power = std::min(light.bounds.power, std::numeric_limits<float>::max());
    power_ += light.bounds.power;
  }
  if (lights.empty()) return;
  parallel_for(lights.size(), [&](size_t i) {
    LightBounds& bounds = lights[i].bounds;
    // As parts of the whole, powers of any size have sums and quotients that float can hold.
    bounds.power = std::max(float(bounds.power / power_), std::numeric_limits<float>::min());
    // Without a direction it may shine to all sides.
    if (std::abs(length_squared(bounds.axis) - 1) < 1e-3f) return;
    bounds.axis = {0, 0, 1};
    bounds.cos_spread = -1;
  });
  nodes_ = build_light_nodes(lights);
  parallel_for(nodes_.size(), [&](size_t node) {
    for (int slot = 0; slot < LightNode::width; ++slot)
      if (nodes_[node].is_light(slot))
        places_[nodes_[node].child(slot)] = uint32_t(node) * LightNode::width + uint32_t(slot);
  });
}

LightTree::Weights LightTree::weigh(const LightNode& node, const LightReceiver& receiver) {
  const Float8 weights = node.importance(receiver);
  return {weights, sum(weights)};
}

LightTree::Weights LightTree::weigh(const LightReceiver& receiver) const {
  return nodes_.empty() ? Weights{} : weigh(nodes_.front(), receiver);
}

LightTree::Pick LightTree::sample(const LightReceiver& receiver, Weights weights, double u) const {
  double prob = 1;
  const LightNode* node = nodes_.data();
  while (weights.sum > 0) {
    // The slot whose share of u it is; rounding may run past the last.
    double rest = u * weights.sum;
    int slot = -1;
    for (int i = 0; i < LightNode::width; ++i) {
      if (!(weights.slots[i] > 0)) continue;
      if (slot >= 0) rest -= weights.slots[slot];
      slot = i;
      if (rest < weights.slots[i]) break;
    }
    prob *= weights.slots[slot] / weights.sum;
    if (node->is_light(slot)) return {node->child(slot), prob};
    // Stretched to choose within it. What a choice takes of the digits of u is what makes it improbable.
    u = std::clamp(rest / weights.slots[slot], 0.0, 1.0);
    node += node->child(slot);
    weights = weigh(*node, receiver);
  }
  return {};
}

double LightTree::prob(const LightReceiver& receiver, const Weights& root, uint32_t light) const {
  if (places_[light] == nowhere) return 0;
  double prob = 1;
  const LightNode* node = &nodes_[places_[light] / LightNode::width];
  for (int slot = int(places_[light] % LightNode::width);;) {
    const bool is_root = node->to_parent() == 0;
    const Weights weights = is_root ? root : weigh(*node, receiver);
    if (!(weights.slots[slot] > 0)) return 0;
    prob *= weights.slots[slot] / weights.sum;
    if (is_root) return prob;
    slot = node->slot_in_parent();
    node -= node->to_parent();
  }
}

}  // namespace vernier
