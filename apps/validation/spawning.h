// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/validation/leaks.h"

// Rays that leave surfaces: they must not meet what they leave, and must meet what is near it.

namespace vernier::validation {

/// How the next ray's origin is found.
enum class Spawn {
  error_bounds,   ///< SurfacePoint::spawn()
  fixed_epsilon,  ///< 1e-4 along the normal, as many renderers do
};

struct SpawnCase {
  float scale = 1;         ///< size of the triangles, in metres
  float offset = 0;        ///< distance of the scene from the world's origin, in units of scale
  bool instanced = false;  ///< through a transform with rotation and stretching
  bool copied = false;     ///< self_hits(): each triangle has a copy in the same place
  Spawn spawn = Spawn::error_bounds;
};

/// Rays off triangles, to both sides, at cosines from 1e-4 to 1 to the normal, that hit the triangle they
/// leave or its copy. The ray itself says which triangle it leaves; from a copy only its origin's offset
/// keeps it.
Count self_hits(BuildAccelerator build, const SpawnCase& spawn_case, uint64_t rays, uint64_t seed);

/// Rays from one sheet to another that is `gap` units in the last place of the largest coordinate away, that
/// miss it.
Count missed_gaps(BuildAccelerator build, const SpawnCase& spawn_case, unsigned gap, uint64_t rays,
                  uint64_t seed);

/// The narrowest gap, among powers of two, at and above which no ray of missed_gaps() is lost; 0 when even
/// 4096 is not enough.
unsigned smallest_gap(BuildAccelerator build, const SpawnCase& spawn_case, uint64_t rays, uint64_t seed);

}  // namespace vernier::validation
