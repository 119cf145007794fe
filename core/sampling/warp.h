// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/math.h"

// Maps from [0,1)^2, each sample_x beside the density x_pdf it produces.

namespace vernier {

/// Rounded down, so that it stays below 1.
inline Vec2f to_float(const Vec2d& u) {
  const auto rounded = [](double v) { return std::min(float(v), 0x1.fffffep-1f); };
  return {rounded(u.x), rounded(u.y)};
}

/// Concentric map of the square to the unit disk (Shirley and Chiu 1997), polar radius and angle chosen per
/// wedge.
inline Vec2f sample_disk(const Vec2f& u) {
  const float a = 2 * u.x - 1;
  const float b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  float r, phi;
  if (std::abs(a) > std::abs(b)) {
    r = a;
    phi = (pi / 4) * (b / a);
  } else {
    r = b;
    phi = pi / 2 - (pi / 4) * (a / b);
  }
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// Cosine-weighted direction about +z.
inline Vec3f sample_cosine_hemisphere(const Vec2f& u) {
  const Vec2f d = sample_disk(u);
  return {d.x, d.y, safe_sqrt(1 - d.x * d.x - d.y * d.y)};
}
inline float cosine_hemisphere_pdf(float cos_theta) { return std::max(0.f, cos_theta) * inv_pi; }

/// Uniform direction on the sphere.
inline Vec3f sample_sphere(const Vec2f& u) {
  const float z = 1 - 2 * u.x;
  const float r = safe_sqrt(1 - z * z);
  const float phi = 2 * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}
inline float sphere_pdf() { return inv_pi / 4; }

/// Barycentrics (u, v) of v1 and v2, uniform by area, with low distortion
/// (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
inline Vec2f sample_triangle(const Vec2f& u) {
  float x = u.x, y = u.y;
  if (y > x) {
    x *= 0.5f;
    y -= x;
  } else {
    y *= 0.5f;
    x -= y;
  }
  return {x, y};
}

/// The u that sample_triangle() maps to these barycentrics.
inline Vec2f invert_sample_triangle(const Vec2f& barycentrics) {
  const float sum = barycentrics.x + barycentrics.y;
  return barycentrics.y > barycentrics.x ? Vec2f(2 * barycentrics.x, sum) : Vec2f(sum, 2 * barycentrics.y);
}

}  // namespace vernier
