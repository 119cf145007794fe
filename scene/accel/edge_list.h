// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include "core/math/simd.h"
#include "scene/accel/accelerator.h"
#include "scene/accel/triangle.h"
#include "scene/accel/triangle_set.h"

namespace vernier {

/// Every triangle for every ray, for scenes so small that a tree takes longer. Eight at once are held against
/// the ray by the sides on which it passes their edges, products of Pluecker coordinates (Shoemake 1998,
/// "Pluecker Coordinate Tutorial", Ray Tracing News 11(1)), in float and with room for all rounding. What is
/// left, mostly one triangle, goes through intersect_watertight(), so the answers are those of `bvh` to the
/// bit.
class EdgeList {
 public:
  EdgeList() = default;
  explicit EdgeList(TriangleSet triangles);

  const Bounds& bounds() const { return bounds_; }
  size_t bytes() const { return blocks_.capacity() * sizeof(Block) + members_.capacity() * sizeof(Member); }

  /// As Structure in two_level.h.
  template <bool ordered, typename Blocks>
  bool traverse(const Ray& ray, QueryCost* cost, Blocks&& blocks) const;

 private:
  static constexpr unsigned lanes = 8;

  /// Eight triangles in the list's space, where they are about the origin and of about its size. Lanes
  /// without a triangle have an offset that is not a number, which no comparison takes.
  struct alignas(64) Block {
    Float8 direction[3][3], moment[3][3];  ///< [edge][axis]; edge i is opposite of vertex i
    Float8 normal[3], offset;              ///< dot(normal, p) is the offset for p of the plane
    Float8 rounding;                       ///< times those of a Line they bound the errors of the tests
  };

  struct Member {
    std::array<Vec3f, 3> corners;
    uint32_t instance, primitive;
  };

  /// A ray in the list's space.
  struct Line {
    Vec3f origin, direction, moment;
    float t_min, t_max;
    float side_rounding, near_rounding, far_rounding;
  };
  Line line(const Ray& ray, float t_max) const;
  /// The same for directions so long or short that products of theirs would leave the range of numbers.
  void rescale(const Ray& ray, Line& line) const;
  /// The lanes that the ray may meet in [t_min, t_max].
  static unsigned candidates(const Block& block, const Line& line);

  Bounds bounds_;
  Vec3f center_{0.f};
  float scale_ = 1;  ///< a power of two
  std::vector<Block> blocks_;
  std::vector<Member> members_;  ///< by block and lane
};

/// Whether the list answers soonest for a geometry: few triangles, all in world space and at rest.
bool suits_edge_list(const Geometry& geometry);

std::unique_ptr<Accelerator> build_edge_list(const Geometry& geometry);

inline EdgeList::Line EdgeList::line(const Ray& ray, float t_max) const {
  const auto size = [](const Vec3f& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
  Line line;
  line.origin = (ray.origin - center_) * scale_;
  line.direction = ray.direction * scale_;
  line.t_min = ray.t_min;
  line.t_max = t_max;
  float stretch = size(line.direction);
  if (!(stretch > 0x1p-30f && stretch < 0x1p30f)) [[unlikely]] {
    rescale(ray, line);
    stretch = size(line.direction);
  }
  line.moment = cross(line.origin, line.direction);
  // Products with infinity would not be numbers where slopes are 0.
  line.t_max = std::min(line.t_max, 0x1p80f);
  const float reach = 2 + size(line.origin);
  line.side_rounding = reach * stretch;
  line.near_rounding = reach * (reach + line.t_min * stretch);
  line.far_rounding = reach * (reach + line.t_max * stretch);
  return line;
}

inline unsigned EdgeList::candidates(const Block& block, const Line& line) {
  const Vec3f &o = line.origin, &d = line.direction, &l = line.moment;
  const auto side = [&](int edge) {
    const auto &e = block.direction[edge], &m = block.moment[edge];
    return multiply_add(
        e[0], l.x,
        multiply_add(e[1], l.y,
                     multiply_add(e[2], l.z, multiply_add(m[0], d.x, multiply_add(m[1], d.y, m[2] * d.z)))));
  };
  const Float8 u = side(0), v = side(1), w = side(2);
  // Their sum is dot(normal, direction). With its sign turned to positive, the inside of the edges is too.
  const Float8 slope = u + v + w;
  const Mask8 sign = signs_of(slope);
  Float8 inmost = flipped(u, sign);
  keep_smaller(flipped(v, sign), inmost);
  keep_smaller(flipped(w, sign), inmost);
  const auto& n = block.normal;
  const Float8 depth =
      multiply_add(n[0], -o.x, multiply_add(n[1], -o.y, multiply_add(n[2], -o.z, block.offset)));
  const Float8 at = flipped(depth, sign), steepness = flipped(slope, sign);
  const Float8 least = multiply_add(steepness, line.t_min, block.rounding * -line.near_rounding);
  const Float8 most = multiply_add(steepness, line.t_max, block.rounding * line.far_rounding);
  return lane_bits((inmost >= block.rounding * -line.side_rounding) & (at >= least) & (at <= most));
}

template <bool ordered, typename Blocks>
[[gnu::always_inline]] inline bool EdgeList::traverse(const Ray& ray, QueryCost* cost,
                                                      Blocks&& blocks) const {
  constexpr size_t blocks_a_word = 64 / lanes;
  for (size_t first = 0; first < blocks_.size(); first += blocks_a_word) {
    // All blocks before any candidate: a branch for each block would be guessed wrong too often.
    const Line tested = line(ray, blocks.t_max());
    const size_t count = std::min(blocks_.size() - first, blocks_a_word);
    uint64_t left = 0;
    for (size_t i = 0; i < count; ++i)
      left |= uint64_t(candidates(blocks_[first + i], tested)) << (i * lanes);
    if (cost) cost->blocks += count * lanes / TriangleBlock::lanes;
    if (!left) continue;
    const ShearedRay sheared(ray.origin, ray.direction);
    for (; left; left &= left - 1) {
      const Member& member = members_[first * lanes + size_t(std::countr_zero(left))];
      // First, as both ends of most rays lie on triangles that are candidates within rounding.
      if (blocks.passes_over(member.instance, member.primitive)) continue;
      const auto& [v0, v1, v2] = member.corners;
      const auto hit = intersect_watertight(sheared, v0, v1, v2);
      if (!hit || !(hit->t > ray.t_min && hit->t <= blocks.t_max())) continue;
      if (blocks.meet({hit->t, hit->u, hit->v, member.instance, member.primitive})) return true;
    }
  }
  return false;
}

}  // namespace vernier
