// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/validation/leaks.h"
#include "apps/validation/soup.h"

// Whether hits are the right ones, and how exact.

namespace vernier::validation {

/// Two accelerators on the same rays.
struct Disagreements {
  uint64_t rays = 0;
  uint64_t within_rounding =
      0;  ///< the ray passes a boundary within rounding, or two surfaces meet within the error of t
  uint64_t real = 0;  ///< one of the two is wrong
};

/// closest() and occluded() of both on random rays through the soup, every fourth aimed at an edge or vertex.
/// Instances must lie in world space.
Disagreements compare(const Accelerator& a, const Accelerator& b, const TriangleSoup& soup, uint64_t rays,
                      uint64_t seed);

/// Largest errors met, in units of the bounds of ExactHit: above 1 a result is worse than float arithmetic
/// excuses.
struct HitErrors {
  Count wrong;  ///< hits and misses that the exact answer denies, not near a boundary
  double t = 0, u = 0, v = 0;
};

/// Rays at one random triangle a scene from 1 to 1000 times its size; `needle` is its height over its length,
/// 1 for regular ones, `offset` moves everything from the origin.
HitErrors hit_errors(BuildAccelerator build, float needle, float offset, uint64_t rays, uint64_t seed);

/// The phantom of Embree's issue 387: triangles 11.1 long and `height` high, from 600 away at half a degree.
HitErrors needle_errors(BuildAccelerator build, float height, uint64_t rays, uint64_t seed);

/// Instances with a transform against the same triangles carried into the world in double: the largest
/// difference in t over t, in units of eps times the transform's distortion.
double instance_error(BuildAccelerator build, const Vec3f& scale, const Vec3f& origin, uint64_t rays,
                      uint64_t seed);

}  // namespace vernier::validation
