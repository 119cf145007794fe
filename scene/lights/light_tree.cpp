#include "scene/lights/light_tree.h"

#include <array>
#include <numeric>

namespace vernier {
namespace {

constexpr int buckets = 12;
constexpr int max_split_depth = 32;  // below this the middle halves what is left: a trail has 64 bits

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

}  // namespace

LightTree::LightTree(std::span<const LightBounds> bounds) : trail_(bounds.size(), 0) {
  std::vector<uint32_t> lights;
  for (uint32_t i = 0; i < bounds.size(); ++i)
    if (bounds[i].power > 0) lights.push_back(i);
  if (lights.empty()) return;
  nodes_.reserve(2 * lights.size());
  build(bounds, lights, 0, 0);
}

uint32_t LightTree::build(std::span<const LightBounds> bounds, std::span<uint32_t> lights, uint64_t trail,
                          int depth) {
  const auto index = uint32_t(nodes_.size());
  nodes_.emplace_back();
  if (lights.size() == 1) {
    nodes_[index] = {bounds[lights[0]], 0, lights[0]};
    trail_[lights[0]] = trail;
    return index;
  }

  Bounds box, centers;
  for (const uint32_t i : lights) {
    box.add(bounds[i].box.lower);
    box.add(bounds[i].box.upper);
    centers.add(bounds[i].box.center());
  }
  const auto bucket_of = [&](uint32_t light, int axis) {
    const float width = centers.upper[axis] - centers.lower[axis];
    const float place = (bounds[light].box.center()[axis] - centers.lower[axis]) / width;
    return std::clamp(int(place * buckets), 0, buckets - 1);
  };
  float best_cost = std::numeric_limits<float>::infinity();
  int best_axis = -1, best_split = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(centers.upper[axis] > centers.lower[axis])) continue;
    std::array<LightBounds, buckets> groups{};
    for (const uint32_t i : lights) {
      LightBounds& group = groups[size_t(bucket_of(i, axis))];
      group = merge(group, bounds[i]);
    }
    std::array<LightBounds, buckets> above{};
    LightBounds running;
    for (size_t b = buckets - 1; b > 0; --b) above[b] = running = merge(running, groups[b]);
    LightBounds below;
    for (int split = 1; split < buckets; ++split) {
      below = merge(below, groups[size_t(split) - 1]);
      const float c = cost(below, box, axis) + cost(above[size_t(split)], box, axis);
      if (below.power > 0 && above[size_t(split)].power > 0 && c < best_cost) {
        best_cost = c;
        best_axis = axis;
        best_split = split;
      }
    }
  }
  auto middle = lights.begin() + ptrdiff_t(lights.size() / 2);
  if (best_axis >= 0 && depth < max_split_depth)
    middle = std::stable_partition(lights.begin(), lights.end(),
                                   [&](uint32_t i) { return bucket_of(i, best_axis) < best_split; });
  const auto count = size_t(middle - lights.begin());
  build(bounds, lights.first(count), trail, depth + 1);
  const uint32_t right = build(bounds, lights.subspan(count), trail | (uint64_t(1) << depth), depth + 1);
  nodes_[index] = {merge(nodes_[index + 1].bounds, nodes_[right].bounds), right, 0};
  return index;
}

LightTree::Pick LightTree::sample(const LightReceiver& receiver, float u) const {
  if (nodes_.empty() || !(nodes_[0].bounds.importance(receiver) > 0)) return {};
  float prob = 1;
  uint32_t index = 0;
  while (nodes_[index].right != 0) {
    const float left = nodes_[index + 1].bounds.importance(receiver);
    const float right = nodes_[nodes_[index].right].bounds.importance(receiver);
    if (!(left + right > 0)) return {};
    const float left_prob = left / (left + right);
    if (u < left_prob) {
      u /= left_prob;
      prob *= left_prob;
      index = index + 1;
    } else {
      u = (u - left_prob) / (1 - left_prob);
      prob *= 1 - left_prob;
      index = nodes_[index].right;
    }
    u = std::min(u, 0x1.fffffep-1f);
  }
  return {nodes_[index].light, prob};
}

float LightTree::prob(const LightReceiver& receiver, uint32_t light) const {
  if (nodes_.empty() || !(nodes_[0].bounds.importance(receiver) > 0)) return 0;
  float prob = 1;
  uint32_t index = 0;
  for (uint64_t trail = trail_[light]; nodes_[index].right != 0; trail >>= 1) {
    const float left = nodes_[index + 1].bounds.importance(receiver);
    const float right = nodes_[nodes_[index].right].bounds.importance(receiver);
    if (!(left + right > 0)) return 0;
    const float left_prob = left / (left + right);
    prob *= trail & 1 ? 1 - left_prob : left_prob;
    index = trail & 1 ? nodes_[index].right : index + 1;
  }
  return prob;
}

}  // namespace vernier
