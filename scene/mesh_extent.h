// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "scene/bounds.h"
#include "vernier/scene.h"

namespace vernier {

/// A point of something that lies farthest along a direction.
struct FarthestCorner {
  Vec3f point{0, 0, 0};
  float along = -std::numeric_limits<float>::infinity();  ///< dot(point, direction); this: there is none
};

/// Boxes about runs of a mesh's triangles, in levels: tells where the mesh ends, wherever it is placed, by
/// looking at few of its vertices. What it tells is what looking at all of them would, to the last bit.
class MeshExtent {
 public:
  MeshExtent() = default;
  /// The arrays must outlive it.
  MeshExtent(std::span<const Vec3f> positions, std::span<const Triangle> triangles);

  /// About all corners of triangles, placed by `to_world`, that are finite.
  Bounds bounds(const Transform& to_world) const;
  /// Of these the first, in the order of the triangles, that no other exceeds.
  FarthestCorner farthest(const Transform& to_world, const Vec3f& direction) const;

 private:
  template <typename Visitor>
  class Search;

  std::span<const Vec3f> positions_;
  std::span<const Triangle> triangles_;
  std::vector<std::vector<Bounds>> levels_;  ///< from runs of triangles to one box about all
};

}  // namespace vernier
