// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/validation/count.h"

// Input at and beyond the edge of what makes sense.

namespace vernier::validation {

/// Sizes in powers of ten of a triangle and its distance from the ray, at and between which it is hit where
/// it is; 0 and 0 when not even size 1 is.
struct SizeRange {
  double smallest = 0, largest = 0;
};
/// `flush_denormals`: in threads that take denormal numbers for zero, as Embree's manual recommends.
SizeRange sizes_hit(BuildAccelerator build, bool flush_denormals);

/// Hits where there can be none: on triangles without area or with vertices that are not finite, by rays in
/// the plane of a triangle, and by rays that are not finite or have no direction.
Count phantom_hits(BuildAccelerator build, uint64_t rays, uint64_t seed);

/// Answers of closest(), occluded() and all_hits() that do not fit the open interval (t_min, t_max): ends at,
/// just before and just behind a hit, empty and infinite ones, and rays that start on a surface.
Count interval_errors(BuildAccelerator build, uint64_t rays, uint64_t seed);

/// Seconds that rays which are not finite take over what valid ones do.
double invalid_ray_cost(BuildAccelerator build, uint64_t rays, uint64_t seed);

}  // namespace vernier::validation
