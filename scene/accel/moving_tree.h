// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/math/moments.h"
#include "scene/accel/triangle_set.h"

// What of a geometry moves, for the accelerators here.

namespace vernier {

/// Moving triangles of one or several meshes, known at equally many moments.
struct MovingTriangles {
  size_t moments = 0;
  TriangleSet triangles;
};

/// The vertices of a block at each moment, one block each, and the block at a time in between.
inline TriangleBlock block_between(const TriangleBlock* at_moments, const MomentPair& time) {
  const TriangleBlock &from = at_moments[time.first], &to = at_moments[time.first + 1];
  TriangleBlock block = from;
  for (int vertex = 0; vertex < 3; ++vertex)
    for (int axis = 0; axis < 3; ++axis)
      block.vertex[vertex][axis] =
          from.vertex[vertex][axis] * (1 - time.part) + to.vertex[vertex][axis] * time.part;
  return block;
}

/// Moving triangles, four a leaf, under a WideTree whose boxes are kept at each moment, and are in between as
/// the vertices are: linear, so that a box holds at every time what it holds at both moments. Boxes over all
/// of the shutter, the alternative, hold much that is not there at any one time.
class MovingTree {
 public:
  explicit MovingTree(MovingTriangles moving);

  size_t bytes() const;
  /// As TwoLevel::refit().
  void refit();

  /// As Structure in two_level.h. A block that is shown is gone after visit().
  template <bool ordered, typename Blocks>
  bool traverse(const Ray& ray, QueryCost* cost, Blocks&& blocks) const;

 private:
  size_t moments_;
  TriangleSet triangles_;
  WideTree tree_;                         ///< its own boxes are those of all of the shutter
  HugePageVector<Planes> planes_;         ///< by node and moment
  HugePageVector<TriangleBlock> blocks_;  ///< by leaf and moment
};

template <bool ordered, typename Blocks>
bool MovingTree::traverse(const Ray& ray, QueryCost* cost, Blocks&& blocks) const {
  struct Leaves {
    const MovingTree& self;
    MomentPair time;
    Blocks& blocks;

    const TriangleBlock* at(uint32_t leaf) const { return &self.blocks_[leaf * self.moments_]; }
    float t_max() const { return blocks.t_max(); }
    bool visit(uint32_t leaf) { return blocks.visit(block_between(at(leaf), time)); }
    void prefetch(uint32_t leaf) const { prefetch_lines(at(leaf) + time.first, 2 * sizeof(TriangleBlock)); }
  };
  const MomentPair time = moments_around(ray.time, moments_);
  const auto planes_of = [&](uint32_t node) {
    const Planes *from = &planes_[node * moments_ + time.first], *to = from + 1;
    Planes planes;
    for (size_t i = 0; i < planes.size(); ++i)
      planes[i] = (*from)[i] * (1 - time.part) + (*to)[i] * time.part;
    return planes;
  };
  Leaves leaves{*this, time, blocks};
  const SlabRay slab_ray(ray.origin, ray.direction, tree_.bounds());
  return tree_.traverse<ordered>(slab_ray, ray.t_min, cost, leaves, planes_of);
}

}  // namespace vernier
