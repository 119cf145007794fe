// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "vernier/math.h"

namespace vernier {

/// Bound n u / (1 - n u) on the relative error of n chained float operations, u = 2^-24
/// (Higham 2002, "Accuracy and Stability of Numerical Algorithms", lemma 3.1).
constexpr float gamma_bound(int n) {
  constexpr float unit_roundoff = std::numeric_limits<float>::epsilon() / 2;
  return static_cast<float>(n) * unit_roundoff / (1 - static_cast<float>(n) * unit_roundoff);
}

/// The next larger float; NaN and infinity stay. What std::nextafter gives, without a call: each ray needs
/// it.
inline float next_float_up(float v) {
  if (!(v < std::numeric_limits<float>::infinity())) return v;
  const auto bits = std::bit_cast<int32_t>(v + 0.f);  // of -0 makes 0
  return std::bit_cast<float>(bits + (bits < 0 ? -1 : 1));
}
inline float next_float_down(float v) { return -next_float_up(-v); }

/// Ray origin beside a surface point p known to within +-error per axis: p moved along the unit normal n far
/// enough that the true surface cannot lie between, to the side that `direction` leaves by (Pharr, Jakob,
/// Humphreys 2023, "Physically Based Rendering", 4th ed., 6.8.6).
inline Vec3f offset_ray_origin(const Vec3f& p, const Vec3f& error, const Vec3f& n, const Vec3f& direction) {
  const float distance = dot(abs(n), error);
  Vec3f offset = distance * n;
  if (dot(direction, n) < 0) offset = -offset;
  Vec3f origin = p + offset;
  for (int axis = 0; axis < 3; ++axis) {
    // The sum itself rounds; step away once more so that it cannot round back.
    if (offset[axis] > 0) origin[axis] = next_float_up(origin[axis]);
    if (offset[axis] < 0) origin[axis] = next_float_down(origin[axis]);
  }
  return origin;
}

}  // namespace vernier
