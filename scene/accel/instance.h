// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "scene/accel/accelerator.h"
#include "scene/accel/wide_tree.h"

// What the accelerators share about meshes placed by a transform.

namespace vernier {

/// The way from the world into a mesh's own space, in double, so that a point carried there is off by half an
/// ulp of its coordinates in that space.
struct WorldToMesh {
  Vec3d x, y, z, origin;  ///< columns, as in Transform

  /// Empty when rays cannot be carried over: not finite, singular (a scale of zero is legal in glTF), or with
  /// a distortion so great that the carried ray would lose sight of what it aims at. Such instances are
  /// baked.
  static std::optional<WorldToMesh> of(const Transform& to_world);

  /// How much the way into the mesh's space and back blows up rounding errors: the largest row sum of
  /// |M| |M^-1|; 1 for scaling along the axes, up to 3 for rotations, and as large as the ratio of scales for
  /// rotated stretches.
  double distortion(const Transform& to_world) const;

  Vec3f vector(const Vec3f& v) const { return Vec3f(x * double(v.x) + y * double(v.y) + z * double(v.z)); }
  Vec3f point(const Vec3f& p) const {
    return Vec3f(x * double(p.x) + y * double(p.y) + z * double(p.z) + origin);
  }
};

/// The mesh's positions in world space, computed in double and rounded once; padded as GeometryMesh asks, so
/// the vector is longer than the mesh.
std::vector<Vec3f> bake_positions(const GeometryMesh& mesh, const Transform& to_world);

/// A box that holds the mesh-space box carried into the world, rounded outward.
Bounds transformed_box(const Bounds& box, const Transform& to_world);

}  // namespace vernier
