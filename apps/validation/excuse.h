// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "apps/validation/exact.h"

namespace vernier::validation {

/// Why two answers to one ray may differ by rounding alone.
enum class Excuse {
  none,      ///< they may not: one of them is wrong
  boundary,  ///< one lies at the edge of a triangle
  end,       ///< one lies at an end of the ray's interval
  tie        ///< both surfaces are met at one distance
};

/// Of a ray that met the triangle `a` by one answer and `b` by another; empty: nothing. The triangles are
/// given in the world. `distortion` is by how much the ways to their own spaces blow up rounding, 1 for
/// triangles that lie in the world.
Excuse excuse(const Ray& ray, const std::optional<Corners>& a, const std::optional<Corners>& b,
              double distortion = 1);

}  // namespace vernier::validation
