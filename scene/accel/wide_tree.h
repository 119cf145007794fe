// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "core/math/simd.h"
#include "scene/accel/accelerator.h"
#include "scene/accel/huge_pages.h"
#include "scene/bounds.h"
#include "vernier/math.h"

// A bounding volume hierarchy of eight children a node over anything that has a box: triangles for `bvh`,
// instances for the top level of every accelerator here.

namespace vernier {

/// Eight boxes: lower x, y, z, upper x, y, z.
using Planes = std::array<Float8, 6>;

/// Boxes of up to eight children, each child another node, a leaf, or empty (a box that no ray meets).
struct alignas(64) WideNode {
  static constexpr unsigned width = 8;

  Planes planes;
  uint32_t child[width]{};     ///< index of a leaf or a node
  uint8_t used = 0, leaf = 0;  ///< bit i: child i is there; is a leaf

  WideNode();
  void set_box(unsigned slot, const Bounds& box);
  Bounds box(unsigned slot) const;
  Bounds bounds() const;
};

/// The ray as the boxes see it. A box that holds a triangle which the watertight test accepts is never
/// missed, whatever the rounding: that test moves vertices by at most 5u (|x| + |z|) across the ray, u =
/// 2^-24, x and z their distances from the origin across and along it, so the planes are moved by as much,
/// taken for the farthest corner of `scene`; and the three roundings of (plane - origin) / direction are paid
/// for by two ulps of the reciprocal (Woop, Benthin, Wald 2013, section 4; Ize 2013, "Robust BVH Ray
/// Traversal", JCGT 2(2)).
struct SlabRay {
  Float4 near_origin, far_origin, near_scale, far_scale;  ///< x, y, z
  unsigned near_plane[3], far_plane[3];

  /// `distortion` widens the slack where rays are rounded once more on their way into a mesh's space.
  SlabRay(const Vec3f& origin, const Vec3f& direction, const Bounds& scene, float distortion = 1);

  /// The boxes that the ray meets in [t_min, t_max], as bits, and where it enters each.
  unsigned meets(const Planes& planes, float t_min, float t_max, Float8& enters) const;
};

struct BuildItem {
  Bounds box;
  uint32_t id = 0;
};

class WideTree {
 public:
  WideTree() = default;

  /// Binned SAH, in parallel. Reorders `items` so that leaf i holds leaf_range(i) of them; a leaf holds at
  /// most `leaf_size`, and counts as one test whatever it holds.
  WideTree(std::span<BuildItem> items, unsigned leaf_size);

  bool empty() const { return nodes_.empty(); }
  const Bounds& bounds() const { return bounds_; }
  size_t bytes() const { return nodes_.capacity() * sizeof(WideNode); }
  size_t leaf_count() const { return leaf_count_; }

  struct Leaf {
    uint32_t first, count;
  };
  /// The leaves by index; taken away by the caller, who needs them only to fill its own.
  std::vector<Leaf> take_leaves() { return std::move(leaves_); }

  /// New boxes for the same tree, from those of its leaves.
  template <typename LeafBox>
  void refit(const LeafBox& leaf_box);

  /// Shows the leaves that the ray may meet in [t_min, leaves.t_max()], nearest box first if `ordered`, until
  /// one says stop. Leaves: float t_max() const; bool visit(uint32_t leaf), true to stop; void
  /// prefetch(uint32_t leaf) const.
  template <bool ordered, typename Leaves>
  bool traverse(const SlabRay& ray, float t_min, QueryCost* cost, Leaves&& leaves) const {
    const auto own = [this](uint32_t node) -> const Planes& { return nodes_[node].planes; };
    return traverse<ordered>(ray, t_min, cost, leaves, own);
  }
  /// The same with other boxes: planes_of(node) are the planes of a node's.
  template <bool ordered, typename Leaves, typename PlanesOf>
  bool traverse(const SlabRay& ray, float t_min, QueryCost* cost, Leaves& leaves,
                const PlanesOf& planes_of) const;

  /// By node, as the boxes are now.
  std::span<const WideNode> nodes() const { return nodes_; }

 private:
  static constexpr unsigned max_depth = 96;  ///< of the binary splits, kept by the builder
  HugePageVector<WideNode> nodes_;           ///< children after their parents
  std::vector<Leaf> leaves_;
  size_t leaf_count_ = 0;
  Bounds bounds_;
};

inline SlabRay::SlabRay(const Vec3f& origin, const Vec3f& direction, const Bounds& scene, float distortion) {
  constexpr float unit_roundoff = std::numeric_limits<float>::epsilon() / 2;
  constexpr float wider = 1 + 2 * std::numeric_limits<float>::epsilon(), narrower = 2 - wider;
  const auto lanes = [](const Vec3f& v) { return Float4{v.x, v.y, v.z, 0}; };
  const Float4 o = lanes(origin), d = lanes(direction);
  const Float4 below = magnitude(lanes(scene.lower) - o), above = magnitude(lanes(scene.upper) - o);
  const Float4 reach = below > above ? below : above;
  const float farthest = std::max(reach[0], std::max(reach[1], reach[2]));
  // Where the moved origin is rounded, it may lose half an ulp of itself.
  const Float4 slack = 6 * unit_roundoff * distortion * (reach + farthest) + 2 * unit_roundoff * magnitude(o);
  const Mask4 backward = signs_of(d);
  const Float4 onward = flipped(slack, backward), scale = 1 / d;
  near_origin = o + onward;
  far_origin = o - onward;
  near_scale = scale * narrower;
  far_scale = scale * wider;
  for (int axis = 0; axis < 3; ++axis) {
    near_plane[axis] = static_cast<unsigned>(axis + (backward[axis] ? 3 : 0));
    far_plane[axis] = static_cast<unsigned>(axis + (backward[axis] ? 0 : 3));
  }
}

inline unsigned SlabRay::meets(const Planes& planes, float t_min, float t_max, Float8& enters) const {
  Float8 enter = (planes[near_plane[0]] - near_origin[0]) * near_scale[0];
  Float8 leave = (planes[far_plane[0]] - far_origin[0]) * far_scale[0];
  // 0 * infinity, for a ray in the plane of a slab, is NaN: a slab that says nothing.
  keep_greater((planes[near_plane[1]] - near_origin[1]) * near_scale[1], enter);
  keep_smaller((planes[far_plane[1]] - far_origin[1]) * far_scale[1], leave);
  keep_greater((planes[near_plane[2]] - near_origin[2]) * near_scale[2], enter);
  keep_smaller((planes[far_plane[2]] - far_origin[2]) * far_scale[2], leave);
  enter = enter > t_min ? enter : t_min - Float8{};
  leave = leave < t_max ? leave : t_max - Float8{};
  enters = enter;
  return lane_bits(enter <= leave);
}

inline void prefetch_lines(const void* memory, size_t bytes) {
  for (size_t offset = 0; offset < bytes; offset += 64)
    __builtin_prefetch(static_cast<const char*>(memory) + offset);
}

template <bool ordered, typename Leaves, typename PlanesOf>
bool WideTree::traverse(const SlabRay& ray, float t_min, QueryCost* cost, Leaves& leaves,
                        const PlanesOf& planes_of) const {
  struct Entry {
    uint32_t node;
    float enters;
  };
  if (nodes_.empty()) return false;
  std::array<Entry, max_depth*(WideNode::width - 1) + 1> stack;
  unsigned size = 0;
  Entry next{0, t_min};
  while (true) {
    const WideNode& node = nodes_[next.node];
    if (cost) ++cost->nodes;
    Float8 enters;
    const unsigned met = ray.meets(planes_of(next.node), t_min, leaves.t_max(), enters);
    const unsigned met_leaves = met & node.leaf, met_nodes = met & ~unsigned{node.leaf};
    for (unsigned slots = met_leaves; slots; slots &= slots - 1) leaves.prefetch(node.child[lowest(slots)]);
    for (unsigned slots = met_nodes; slots; slots &= slots - 1)
      prefetch_lines(&nodes_[node.child[lowest(slots)]], sizeof(WideNode));

    // Leaves first, while the nodes are on their way from memory: a hit there often spares those.
    for (unsigned slots = met_leaves; slots; slots &= slots - 1)
      if (enters[lowest(slots)] <= leaves.t_max() && leaves.visit(node.child[lowest(slots)])) return true;

    // The nearest node is next; the others lie on the stack, the farthest deepest.
    const unsigned first = size;
    for (unsigned slots = met_nodes; slots; slots &= slots - 1) {
      Entry entry{node.child[lowest(slots)], enters[lowest(slots)]};
      if (slots == met_nodes) {
        next = entry;
        continue;
      }
      unsigned place = size++;
      if (ordered) {
        if (entry.enters < next.enters) std::swap(entry, next);
        for (; place > first && stack[place - 1].enters < entry.enters; --place)
          stack[place] = stack[place - 1];
      }
      stack[place] = entry;
    }
    if (met_nodes && next.enters <= leaves.t_max()) continue;
    do {
      if (size == 0) return false;
      next = stack[--size];
    } while (next.enters > leaves.t_max());
  }
}

template <typename LeafBox>
void WideTree::refit(const LeafBox& leaf_box) {
  for (size_t i = nodes_.size(); i-- > 0;) {
    WideNode& node = nodes_[i];
    for (unsigned slot = 0; slot < WideNode::width; ++slot) {
      if (!(node.used >> slot & 1)) continue;
      const uint32_t child = node.child[slot];
      node.set_box(slot, node.leaf >> slot & 1 ? leaf_box(child) : nodes_[child].bounds());
    }
  }
  if (!nodes_.empty()) bounds_ = nodes_[0].bounds();
}

}  // namespace vernier
