// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/light_split.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#include "core/base/parallel.h"
#include "core/math/rounding.h"
#include "scene/lights/light_costs.h"

namespace vernier {
namespace {

constexpr size_t buckets = 12;
constexpr float least_spread = 1e-6f;  // radians: what rounding makes of equal directions
constexpr int max_split_depth = 32;    // below this the middle halves what is left: recursion stays shallow

/// Lights that are worth a task of their own. What is summed is summed by blocks, so that it does not depend
/// on the number of threads.
constexpr size_t block_size = 8192;

size_t block_count(size_t lights) { return (lights + block_size - 1) / block_size; }

/// Calls body(block, first, end) for each block of `count` lights, at once if there are several.
template <typename Body>
void for_each_block(size_t count, const Body& body) {
  const auto block = [&](size_t i) {
    const size_t first = i * block_size;
    body(i, first, std::min(count, first + block_size));
  };
  if (count <= block_size)
    block(0);
  else
    parallel_for(block_count(count), block);
}

/// The groups that the lights of each bucket make, along each axis.
using Buckets = std::array<std::array<LightGroup, buckets>, 3>;

/// Buckets of equal width between the outermost centers.
class Grid {
 public:
  explicit Grid(const LightGroup& group) : lower_(group.center_lower) {
    const Float4 width = group.center_upper - group.center_lower;
    scale_ = width > 0 ? float(buckets) / width : Float4{};
  }

  /// Of a light, along each axis.
  Mask4 bucket_of(const PlacedLight& light) const {
    Float4 place = (light.center() - lower_) * scale_;
    // Not finite where a width is too small for its reciprocal: then in the first or the last.
    place = place > 0 ? place : Float4{};
    place = place < float(buckets - 1) ? place : Float4{} + float(buckets - 1);
    return __builtin_convertvector(place, Mask4);
  }

  void fill(std::span<const PlacedLight> lights, Buckets& groups) const {
    for (const PlacedLight& light : lights) {
      const Mask4 bucket = bucket_of(light);
      for (size_t axis = 0; axis < 3; ++axis) groups[axis][size_t(bucket[axis])].add(light);
    }
  }

 private:
  Float4 lower_, scale_;
};

/// A plane across an axis: which buckets lie below it.
struct Plane {
  size_t axis = 0, first_above = 0;
};

/// The cheapest of the planes between buckets; none: the centers cannot be told apart. Cost as in Conty
/// Estevez and Kulla 2018, eq. 3: long thin boxes are split lengthwise.
std::optional<Plane> cheapest_plane(const LightGroup& all, const Buckets& groups) {
  constexpr int batches = 5;
  constexpr size_t most = 3 * (buckets - 1);
  static_assert(most <= 8 * batches);
  LightCosts<batches> costs_below, costs_above;
  std::array<Plane, most> planes;
  std::array<float, most> regularity;
  size_t count = 0;
  const Float4 size = all.upper - all.lower, room = all.center_upper - all.center_lower;
  const float longest = std::max({size[0], size[1], size[2]});
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!(room[axis] > 0)) continue;
    const float irregularity = longest / std::max(size[axis], std::numeric_limits<float>::min());
    std::array<LightGroup, buckets> above;
    above.back() = groups[axis].back();
    for (size_t b = buckets - 1; b-- > 1;) {
      above[b] = above[b + 1];
      above[b].add(groups[axis][b]);
    }
    LightGroup below;
    for (size_t b = 1; b < buckets; ++b) {
      // After an empty bucket both sides are what they were; of few lights most buckets are.
      if (groups[axis][b - 1].empty()) continue;
      below.add(groups[axis][b - 1]);
      if (above[b].empty()) break;
      costs_below.set(count, below);
      costs_above.set(count, above[b]);
      planes[count] = {axis, b};
      regularity[count++] = irregularity;
    }
  }
  std::optional<Plane> best;
  float least = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < count; i += 8) {
    const Float8 costs = costs_below.of(i / 8) + costs_above.of(i / 8);
    for (size_t lane = 0; lane < 8 && i + lane < count; ++lane) {
      const float cost = regularity[i + lane] * costs[lane];
      if (!(cost < least)) continue;
      least = cost;
      best = planes[i + lane];
    }
  }
  return best;
}

/// Moves lights of which `is_below` is true to the front, on one thread; how many they are.
template <typename Predicate>
size_t partition_alone(std::span<PlacedLight> lights, const Predicate& is_below) {
  size_t first = 0, end = lights.size();
  for (;;) {
    while (first < end && is_below(lights[first])) ++first;
    while (first < end && !is_below(lights[end - 1])) --end;
    if (first == end) return first;
    std::swap(lights[first++], lights[--end]);
  }
}

/// The same on all threads: each block by itself, and then those are exchanged that are on the wrong side.
template <typename Predicate>
size_t partition(std::span<PlacedLight> lights, const Predicate& is_below) {
  if (lights.size() <= block_size) return partition_alone(lights, is_below);
  std::vector<size_t> below(block_count(lights.size()));
  for_each_block(lights.size(), [&](size_t block, size_t first, size_t end) {
    below[block] = partition_alone(lights.subspan(first, end - first), is_below);
  });
  const size_t middle = std::accumulate(below.begin(), below.end(), size_t{0});
  // Of equal length together: what is above in front of the middle, and what is below behind it.
  using Stretch = std::pair<size_t, size_t>;
  std::vector<Stretch> in_front, behind;
  for (size_t block = 0; block < below.size(); ++block) {
    const size_t first = block * block_size, end = std::min(lights.size(), first + block_size),
                 own_middle = first + below[block];
    if (own_middle < std::min(end, middle)) in_front.emplace_back(own_middle, std::min(end, middle));
    if (std::max(first, middle) < own_middle) behind.emplace_back(std::max(first, middle), own_middle);
  }
  struct Exchange {
    size_t a, b, count;
  };
  std::vector<Exchange> exchanges;
  for (auto a = in_front.begin(), b = behind.begin(); a != in_front.end() && b != behind.end();) {
    const size_t count = std::min(a->second - a->first, b->second - b->first);
    exchanges.push_back({a->first, b->first, count});
    if ((a->first += count) == a->second) ++a;
    if ((b->first += count) == b->second) ++b;
  }
  parallel_for(exchanges.size(), [&](size_t i) {
    const auto [a, b, count] = exchanges[i];
    std::swap_ranges(&lights[a], &lights[a] + count, &lights[b]);
  });
  return middle;
}

float unknown(const LightGroup& group) {
  LightCosts<1> cost;
  cost.set(0, group);
  return cost.of(0)[0];
}

LightGroup group_of(std::span<const PlacedLight> lights) {
  std::vector<LightGroup> groups(std::max<size_t>(1, block_count(lights.size())));
  for_each_block(lights.size(), [&](size_t block, size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) groups[block].add(lights[i]);
  });
  for (size_t block = 1; block < groups.size(); ++block) groups[0].add(groups[block]);
  return groups[0];
}

LightRange part_of(const LightRange& range, std::span<PlacedLight> lights, const LightGroup& group) {
  return {lights, group, range.depth + 1, lights.size() > 1 ? unknown(group) : 0};
}

std::pair<LightRange, LightRange> divided(const LightRange& range, size_t middle, const LightGroup& below,
                                          const LightGroup& above) {
  return {part_of(range, range.lights.first(middle), below),
          part_of(range, range.lights.subspan(middle), above)};
}

std::pair<LightRange, LightRange> halved(const LightRange& range) {
  const size_t middle = range.size() / 2;
  return divided(range, middle, group_of(range.lights.first(middle)), group_of(range.lights.subspan(middle)));
}

std::pair<LightRange, LightRange> divided(const LightRange& range, size_t middle,
                                          const std::array<LightGroup, buckets>& groups, size_t first_above) {
  LightGroup below, above;
  for (size_t b = 0; b < buckets; ++b) (b < first_above ? below : above).add(groups[b]);
  return divided(range, middle, below, above);
}

/// Of lights that are no more than buckets: each has one of its own.
std::pair<LightRange, LightRange> split_few(const LightRange& range) {
  std::array<std::array<uint8_t, buckets>, 3> orders;
  Buckets groups;
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto order = std::span(orders[axis]).first(range.size());
    std::iota(order.begin(), order.end(), uint8_t{0});
    std::stable_sort(order.begin(), order.end(), [&](uint8_t a, uint8_t b) {
      return range.lights[a].center()[axis] < range.lights[b].center()[axis];
    });
    for (size_t i = 0; i < order.size(); ++i) groups[axis][i].add(range.lights[order[i]]);
  }
  const auto plane = cheapest_plane(range.group, groups);
  if (!plane) return halved(range);
  std::array<PlacedLight, buckets> ordered;
  for (size_t i = 0; i < range.size(); ++i) ordered[i] = range.lights[orders[plane->axis][i]];
  std::copy_n(ordered.begin(), range.size(), range.lights.begin());
  return divided(range, plane->first_above, groups[plane->axis], plane->first_above);
}

/// Between unit vectors whose tips lie so far apart, squared.
float angle_of(float chord2) { return 2 * std::asin(std::min(1.f, std::sqrt(chord2) / 2)); }

/// The angle about `axis` within which the directions of all lights lie, to either side of a group that is
/// two-sided.
float spread_about(const Vec3f& axis, const LightRange& range) {
  const bool are_narrow = range.group.cos_spread() == 1;
  std::vector<float> widest(block_count(range.size()));
  for_each_block(range.size(), [&](size_t block, size_t first, size_t end) {
    float chord2 = 0, angle = 0;
    for (const PlacedLight& light : range.lights.subspan(first, end - first)) {
      const LightBounds& own = light.bounds;
      const bool is_turned = range.group.two_sided && dot(axis, own.axis) < 0;
      // Between the tips of unit vectors: a distance tells small angles, too.
      const float own_chord2 = length_squared(is_turned ? axis + own.axis : axis - own.axis);
      chord2 = std::max(chord2, own_chord2);
      if (!are_narrow) angle = std::max(angle, angle_of(own_chord2) + std::acos(own.cos_spread));
    }
    widest[block] = are_narrow ? angle_of(chord2) : angle;
  });
  return *std::max_element(widest.begin(), widest.end());
}

}  // namespace

LightRange range_of(std::span<PlacedLight> lights) {
  const LightGroup group = group_of(lights);
  return {lights, group, 0, unknown(group)};
}

std::pair<LightRange, LightRange> split(const LightRange& range) {
  if (range.depth >= max_split_depth || range.size() == 2) return halved(range);
  if (range.size() <= buckets) return split_few(range);
  const Grid grid(range.group);
  std::vector<Buckets> blocks(block_count(range.size()));
  for_each_block(range.size(), [&](size_t block, size_t first, size_t end) {
    grid.fill(range.lights.subspan(first, end - first), blocks[block]);
  });
  Buckets& groups = blocks[0];
  for (size_t block = 1; block < blocks.size(); ++block)
    for (size_t axis = 0; axis < 3; ++axis)
      for (size_t b = 0; b < buckets; ++b) groups[axis][b].add(blocks[block][axis][b]);
  const auto plane = cheapest_plane(range.group, groups);
  if (!plane) return halved(range);
  const size_t middle = partition(range.lights, [&](const PlacedLight& light) {
    return grid.bucket_of(light)[plane->axis] < int(plane->first_above);
  });
  return divided(range, middle, groups[plane->axis], plane->first_above);
}

LightBounds bounds_of(const LightRange& range) {
  if (range.size() == 1) return range.lights[0].bounds;
  const LightGroup& group = range.group;
  const auto xyz = [](const Float4& v) { return Vec3f(v[0], v[1], v[2]); };
  LightBounds bounds;
  bounds.box = {xyz(group.lower), xyz(group.upper)};
  bounds.power = group.power;
  bounds.cos_emission = group.cos_emission;
  bounds.two_sided = group.two_sided;
  bounds.cos_spread = -1;
  const Vec3f middle = xyz(group.axis_lower + group.axis_upper);
  if (!(length_squared(middle) > 1e-6f && group.cos_spread() > -1)) return bounds;
  bounds.axis = normalize(middle);
  const float spread = spread_about(bounds.axis, range);
  if (spread < pi) bounds.cos_spread = spread < least_spread ? 1 : next_float_down(std::cos(spread));
  return bounds;
}

}  // namespace vernier
