// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "vernier/scene.h"

// Meshes moved into world space: as they stand, and as they move while the shutter is open.

namespace vernier {

/// n scaled to unit length; `otherwise` when it has none.
inline Vec3f unit_or(const Vec3f& n, const Vec3f& otherwise) {
  const float length2 = length_squared(n);
  return length2 > 0 && std::isfinite(length2) ? n * (1 / std::sqrt(length2)) : otherwise;
}

/// Moves the arrays of a mesh in place. Winding is left to the caller, who keeps it for all moments.
void carry(const Transform& to_world, std::vector<Vec3f>& positions, std::vector<Vec3f>& normals,
           std::vector<Vec4f>& tangents);

/// The moments in world space of a mesh that moves by itself, by those of its instance, or by both; as many
/// as the more finely known has. An instance without moments stays at `to_world`.
std::vector<MeshShape> moments_in_world(const MeshDescription& mesh, const Transform& to_world,
                                        std::span<const Transform> moments);

/// Throws Error(usage) when there cannot be so many moments, an array of one has another length than that of
/// the mesh, or the instance mirrors the mesh at some of them only.
void check_moments(const MeshDescription& mesh, const InstanceDescription& instance);

/// The same of a camera or a lamp, `what`. Throws Error(usage).
void check_moment_count(size_t count, const std::string& what);

}  // namespace vernier
