// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "scene/accel/accelerator.h"
#include "scene/accel/two_level.h"

namespace vernier {

/// Triangles under a WideTree, four a leaf.
class TriangleTree {
 public:
  TriangleTree() = default;
  explicit TriangleTree(TriangleSet triangles);

  const Bounds& bounds() const { return tree_.bounds(); }
  size_t bytes() const { return tree_.bytes() + blocks_.capacity() * sizeof(TriangleBlock); }
  void refit();

  template <bool ordered, typename Blocks>
  bool traverse(const Ray& ray, QueryCost* cost, Blocks&& blocks) const {
    struct Leaves {
      const HugePageVector<TriangleBlock>& memory;
      Blocks& blocks;

      float t_max() const { return blocks.t_max(); }
      bool visit(uint32_t leaf) { return blocks.visit(memory[leaf]); }
      void prefetch(uint32_t leaf) const { prefetch_lines(&memory[leaf], sizeof(TriangleBlock)); }
    };
    const SlabRay slab_ray(ray.origin, ray.direction, tree_.bounds());
    return tree_.traverse<ordered>(slab_ray, ray.t_min, cost, Leaves{blocks_, blocks});
  }

 private:
  TriangleSet triangles_;
  WideTree tree_;
  HugePageVector<TriangleBlock> blocks_;  ///< by leaf
};

/// The reference accelerator, watertight at edges and vertices.
using Bvh = TwoLevel<TriangleTree, WatertightTest>;

std::unique_ptr<Accelerator> build_bvh(const Geometry& geometry);
/// The same with the test of Moeller and Trumbore, to show what watertightness is worth.
std::unique_ptr<Accelerator> build_bvh_moeller(const Geometry& geometry);

}  // namespace vernier
