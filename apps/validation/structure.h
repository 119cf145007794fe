// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "apps/validation/count.h"

// Scenes on which a bad tree builder loops, overflows a stack, builds a list or takes for ever.

namespace vernier::validation {

struct Stress {
  std::string_view name;
  void (*fill)(TriangleSoup&, uint32_t triangles);
  float size;          ///< half of the cube about the origin where its triangles are
  uint32_t triangles;  ///< enough to hurt
};

/// Coinciding centroids, copies of one triangle, long diagonals, centroids at powers of two, one triangle, a
/// tiny object in a huge one.
std::span<const Stress> stresses();

/// Build time on a scene over that on a plain mesh of as many triangles.
double build_cost(BuildAccelerator build, const Stress& stress);

/// Rays from above at random triangles of a wavy mesh of `triangles` that do not hit the triangle they must.
Count wrong_in_large_mesh(BuildAccelerator build, uint64_t triangles, uint64_t rays, uint64_t seed);

}  // namespace vernier::validation
