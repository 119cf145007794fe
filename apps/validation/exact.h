// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/math/ray.h"

// What is true of a ray and a triangle whose coordinates are taken as the exact numbers that the floats are.

namespace vernier::validation {

using Corners = std::array<Vec3f, 3>;

struct ExactHit {
  enum class Kind {
    miss,
    hit,       ///< through the inside
    boundary,  ///< through an edge or vertex: of the triangles around it at least one must be hit
    coplanar   ///< in the triangle's plane, or the triangle has no area: not hit
  };
  Kind kind = Kind::miss;
  /// Of the point where the line meets the plane, correctly rounded; the interval of the ray is not looked
  /// at.
  double t = 0, u = 0, v = 0;
  /// What float arithmetic may be off by: 8 eps times the sum of the magnitudes of the terms of Cramer's rule
  /// over the magnitude of its denominator, eps = 2^-23 (forward error analysis of any evaluation order, to
  /// first order).
  double t_bound = 0, u_bound = 0, v_bound = 0;
};

/// Decided in double where a forward error bound allows, else in rational numbers. All coordinates must be
/// finite.
ExactHit intersect_exactly(const Ray& ray, const Corners& corners);

/// Smallest distance between the ray's line and the triangle's edges.
double distance_to_boundary(const Ray& ray, const Corners& corners);

/// Whether the line passes so near the boundary that either answer is right: within four units in the last
/// place of the largest coordinate, which is as well as the input itself is known.
bool is_near_boundary(const Ray& ray, const Corners& corners);

/// Spacing of floats at the largest coordinate of origin and corners.
double coordinate_ulp(const Ray& ray, const Corners& corners);

}  // namespace vernier::validation
