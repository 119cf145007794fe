// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/light_tree.h"

#include <array>
#include <optional>

#include "core/base/parallel.h"

namespace vernier {
namespace {

constexpr int buckets = 12;
constexpr int max_split_depth = 32;  // below this the middle halves what is left: recursion stays shallow

/// Solid angle that the emission cones of a group cover, cosine-weighted beyond the spread (Conty Estevez and
/// Kulla 2018, eq. 1).
float orientation_measure(const LightBounds& b) {
  const float spread = std::acos(std::clamp(b.cos_spread, -1.f, 1.f));
  const float emission = std::acos(std::clamp(b.cos_emission, -1.f, 1.f));
  const float widest = std::min(spread + emission, pi);
  const float sin_spread = std::sin(spread);
  const float one_side =
      2 * pi * (1 - b.cos_spread) +
      pi / 2 *
          (2 * widest * sin_spread - std::cos(spread - 2 * widest) - 2 * spread * sin_spread + b.cos_spread);
  return b.two_sided ? 2 * one_side : one_side;
}

float surface_area(const Bounds& box) {
  const Vec3f d = box.upper - box.lower;
  return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

/// Cost of a group within a node whose box is split along `axis`; long thin boxes are split lengthwise.
float cost(const LightBounds& group, const Bounds& parent, int axis) {
  if (group.power == 0) return 0;
  const Vec3f extent = parent.upper - parent.lower;
  const float regularity = max_component(extent) / std::max(extent[axis], std::numeric_limits<float>::min());
  return regularity * group.power * orientation_measure(group) * surface_area(group.box);
}

/// As many lights are worth a task of their own.
constexpr size_t least_parallel = 4096;

/// Calls body(i) for i in [0, count), at once if there is enough to do.
template <typename Body>
void for_each_of_few(bool at_once, size_t count, const Body& body) {
  if (at_once)
    parallel_for(count, body);
  else
    for (size_t i = 0; i < count; ++i) body(i);
}

/// Which lights go below a plane across an axis.
struct Split {
  std::span<const LightBounds> bounds;
  int axis = 0, first_above = 0;  ///< bucket
  float lower = 0, width = 0;     ///< of the centers
  float cost = std::numeric_limits<float>::infinity();

  int bucket_of(uint32_t light) const {
    const float place = (bounds[light].box.center()[axis] - lower) / width;
    return std::clamp(int(place * buckets), 0, buckets - 1);
  }
  bool operator()(uint32_t light) const { return bucket_of(light) < first_above; }
};

/// The cheapest of the splits between buckets along one axis; none has a cost where none divides.
Split cheapest_split(std::span<const LightBounds> bounds, std::span<const uint32_t> lights, const Bounds& box,
                     const Bounds& centers, int axis) {
  Split best{bounds, axis, 0, centers.lower[axis], centers.upper[axis] - centers.lower[axis]};
  if (!(centers.upper[axis] > centers.lower[axis])) return best;
  std::array<LightBounds, buckets> groups{};
  for (const uint32_t i : lights) {
    LightBounds& group = groups[size_t(best.bucket_of(i))];
    group = merge(group, bounds[i]);
  }
  std::array<LightBounds, buckets> above{};
  LightBounds running;
  for (size_t b = buckets - 1; b > 0; --b) above[b] = running = merge(running, groups[b]);
  LightBounds below;
  for (int split = 1; split < buckets; ++split) {
    const LightBounds& next = groups[size_t(split) - 1];
    // After an empty bucket both sides are what they were; of few lights most buckets are.
    if (split > 1 && next.power == 0) continue;
    below = merge(below, next);
    const float c = cost(below, box, axis) + cost(above[size_t(split)], box, axis);
    if (!(below.power > 0 && above[size_t(split)].power > 0 && c < best.cost)) continue;
    best.cost = c;
    best.first_above = split;
  }
  return best;
}

/// The cheapest split along any axis; none: the centers cannot be told apart.
std::optional<Split> cheapest_split(std::span<const LightBounds> bounds, std::span<const uint32_t> lights) {
  Bounds box, centers;
  for (const uint32_t i : lights) {
    box.add(bounds[i].box.lower);
    box.add(bounds[i].box.upper);
    centers.add(bounds[i].box.center());
  }
  std::array<Split, 3> splits;
  for_each_of_few(lights.size() >= least_parallel, splits.size(), [&](size_t axis) {
    splits[axis] = cheapest_split(bounds, lights, box, centers, int(axis));
  });
  const auto best = std::min_element(splits.begin(), splits.end(),
                                     [](const Split& a, const Split& b) { return a.cost < b.cost; });
  return best->cost < std::numeric_limits<float>::infinity() ? std::optional(*best) : std::nullopt;
}

double sum(const Float8& x) {
  return ((double(x[0]) + x[1]) + (double(x[2]) + x[3])) + ((double(x[4]) + x[5]) + (double(x[6]) + x[7]));
}

}  // namespace

LightTree::LightTree(std::vector<LightBounds> bounds) : places_(bounds.size()) {
  std::vector<uint32_t> lights;
  for (uint32_t i = 0; i < bounds.size(); ++i) {
    if (!(bounds[i].power > 0)) continue;
    bounds[i].power = std::min(bounds[i].power, std::numeric_limits<float>::max());
    power_ += bounds[i].power;
    lights.push_back(i);
  }
  if (lights.empty()) return;
  // As parts of the whole, powers of any size have sums and quotients that float can hold.
  for (const uint32_t i : lights)
    bounds[i].power = std::max(float(bounds[i].power / power_), std::numeric_limits<float>::min());
  std::vector<BinaryNode> binary(2 * lights.size() - 1);
  build(binary, 0, bounds, lights, 0);
  bounds = {};
  // Growing would hold the nodes two or three times, and there are hundreds of bytes a light.
  nodes_.reserve(count_wide(binary, 0));
  widen(binary, 0, 0, 0);
}

void LightTree::build(std::span<BinaryNode> nodes, size_t index, std::span<const LightBounds> bounds,
                      std::span<uint32_t> lights, int depth) {
  if (lights.size() == 1) {
    nodes[index] = {bounds[lights[0]], 0, lights[0]};
    return;
  }
  const auto is_below = cheapest_split(bounds, lights);
  auto middle = lights.begin() + ptrdiff_t(lights.size() / 2);
  if (is_below && depth < max_split_depth)
    middle = std::stable_partition(lights.begin(), lights.end(), *is_below);
  // A tree over n lights has 2 n - 1 nodes: it is known where the right one begins before the left is built.
  const auto count = size_t(middle - lights.begin());
  const size_t left = index + 1, right = index + 2 * count;
  const auto build_side = [&](size_t side) {
    if (side == 0)
      build(nodes, left, bounds, lights.first(count), depth + 1);
    else
      build(nodes, right, bounds, lights.subspan(count), depth + 1);
  };
  for_each_of_few(lights.size() >= least_parallel, 2, build_side);
  const LightBounds both = merge(nodes[left].bounds, nodes[right].bounds);
  nodes[index] = {both, uint32_t(right), 0, both.power * orientation_measure(both) * both.box.half_area()};
}

/// The nodes that one wide node stands for: opens the group about which least is known until there are eight.
std::vector<uint32_t> LightTree::members(std::span<const BinaryNode> binary, uint32_t root) {
  std::vector<uint32_t> members{root};
  while (members.size() < LightNode::width) {
    auto widest = members.end();
    float most = -1;
    for (auto member = members.begin(); member != members.end(); ++member) {
      const BinaryNode& node = binary[*member];
      if (node.right != 0 && node.unknown > most) {
        most = node.unknown;
        widest = member;
      }
    }
    if (widest == members.end()) break;
    const uint32_t opened = *widest;
    *widest = opened + 1;
    members.push_back(binary[opened].right);
  }
  return members;
}

size_t LightTree::count_wide(std::span<const BinaryNode> binary, uint32_t root) {
  size_t count = 1;
  for (const uint32_t member : members(binary, root))
    if (binary[member].right != 0) count += count_wide(binary, member);
  return count;
}

uint32_t LightTree::widen(std::span<const BinaryNode> binary, uint32_t root, uint32_t parent, uint32_t slot) {
  const std::vector<uint32_t> members = LightTree::members(binary, root);
  const auto index = uint32_t(nodes_.size());
  nodes_.emplace_back();
  nodes_[index].parent = parent;
  nodes_[index].slot_in_parent = slot;
  for (uint32_t i = 0; i < members.size(); ++i) {
    const BinaryNode& member = binary[members[i]];
    nodes_[index].set(int(i), member.bounds);
    if (member.right == 0) {
      nodes_[index].leaf |= 1u << i;
      nodes_[index].child[i] = member.light;
      places_[member.light] = {index, i};
    } else {
      const uint32_t child = widen(binary, members[i], index, i);
      nodes_[index].child[i] = child;
    }
  }
  return index;
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
    if (node->leaf >> slot & 1) return {node->child[size_t(slot)], prob};
    // Stretched to choose within it. What a choice takes of the digits of u is what makes it improbable.
    u = std::clamp(rest / weights.slots[slot], 0.0, 1.0);
    node = &nodes_[node->child[size_t(slot)]];
    weights = weigh(*node, receiver);
  }
  return {};
}

double LightTree::prob(const LightReceiver& receiver, const Weights& root, uint32_t light) const {
  if (places_[light].slot == LightNode::width) return 0;
  double prob = 1;
  for (auto [index, slot] = places_[light];;) {
    const LightNode& node = nodes_[index];
    const Weights weights = index == 0 ? root : weigh(node, receiver);
    if (!(weights.slots[slot] > 0)) return 0;
    prob *= weights.slots[slot] / weights.sum;
    if (index == 0) return prob;
    slot = node.slot_in_parent;
    index = node.parent;
  }
}

}  // namespace vernier
