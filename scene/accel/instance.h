#pragma once

#include <vector>

#include "scene/accel/accelerator.h"

// What the accelerators share about instances and lists of hits.

namespace vernier {

/// Whether rays can be carried into the instance's space: the inverse exists and neither it nor the matrix
/// overflows. Instances that cannot (a scale of zero is legal in glTF) are baked.
bool is_invertible(const Transform& to_world);

/// The mesh's positions in world space, computed in double and rounded once; padded as GeometryMesh asks, so
/// the vector is longer than the mesh.
std::vector<Vec3f> bake_positions(const GeometryMesh& mesh, const Transform& to_world);

/// Sorts by t, then instance, then primitive, and drops repeats of a triangle.
void sort_hits(std::vector<RawHit>& hits);

}  // namespace vernier
