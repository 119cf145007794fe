// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/validation/count.h"

// Rays aimed where triangles meet. Random rays do not find leaks: they pass within rounding of an edge once
// in millions.

namespace vernier::validation {

/// How the rays are aimed: from `distance` times the size of the triangles, at geometry of size `size` about
/// `center`.
struct Aim {
  float distance = 1;
  float size = 1;
  Vec3f center{0, 0, 0};
};

/// Rays at a point computed on the edge that two folded triangles share, both facing the ray at an angle of
/// cosine above 0.02, that closest() or occluded() lets through.
Count leaks_at_edges(BuildAccelerator build, const Aim& aim, uint64_t rays, uint64_t seed);

/// The same at the vertex that six triangles share.
Count leaks_at_vertices(BuildAccelerator build, const Aim& aim, uint64_t rays, uint64_t seed);

/// Rays from inside a closed surface of 5,120 triangles at its edges and vertices that do not hit it: the
/// whole way through a tree is tested, and every angle to the surface counts.
Count leaks_of_closed_surface(BuildAccelerator build, uint64_t rays, uint64_t seed);

/// Rays from outside at the edges and vertices of a closed surface for which the hits of all_hits() do not go
/// in as often as out. Tests that count an edge for both of its triangles close it, and fail this.
Count parity_errors(BuildAccelerator build, uint64_t rays, uint64_t seed);

}  // namespace vernier::validation
