// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/accel/accelerator.h"
#include "scene/accel/triangle_block.h"
#include "scene/accel/wide_tree.h"

namespace vernier {

/// The triangles of one structure, numbered through: either one mesh in its own space, or all that lie in
/// world space.
class TriangleSet {
 public:
  /// To be called by increasing instance.
  void add(const GeometryMesh& mesh, uint32_t instance);

  std::array<Vec3f, 3> corners(uint32_t triangle) const;

  /// Bounds, in the middle of the shutter, and number of each triangle that can be hit at all, in order.
  std::vector<BuildItem> items() const;

  /// The block of one to four triangles, by number; its vertices are to be loaded.
  TriangleBlock block(std::span<const uint32_t> triangles) const;

  /// Reads the vertices of a block.
  void load(TriangleBlock& block) const;
  /// The same of meshes that move, at one of their moments.
  void load(TriangleBlock& block, size_t moment) const;

 private:
  struct Part {
    GeometryMesh mesh;
    uint32_t instance, first;
  };
  const Part& part_of(uint32_t triangle) const;
  template <typename PositionsOf>
  void load_from(const PositionsOf& positions_of, TriangleBlock& block) const;

  std::vector<Part> parts_;
  uint32_t size_ = 0;
};

/// Whether rays can hit a triangle of a mesh at all; of one that moves, at some time.
bool is_hittable(const GeometryMesh& mesh, const Triangle& triangle);

/// The triangles of a mesh, those that cannot be hit replaced by indices beyond all vertices; empty when
/// there are none such.
std::vector<Triangle> without_unhittable(const GeometryMesh& mesh);

Bounds bounds_of(const TriangleBlock& block);

}  // namespace vernier
