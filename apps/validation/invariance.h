// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/validation/count.h"

// Changes of a query that must not change its answer: no truth is needed to check them.

namespace vernier::validation {

/// Rays whose answer changes when everything is scaled by a power of two from 2^-24 to 2^24: u and v must
/// stay the same bits, and t be scaled (directions are not).
Count changed_by_scaling(BuildAccelerator build, uint64_t rays, uint64_t seed);

/// Rays from a box's faces, edges, corners and beyond, with zeros in their directions, whose answer depends
/// on the signs of the zeros.
Count changed_by_signed_zeros(BuildAccelerator build);

/// Rays that meet another of several coinciding triangles once the accelerator has been built again.
Count changed_by_rebuild(BuildAccelerator build, uint64_t rays, uint64_t seed);

}  // namespace vernier::validation
