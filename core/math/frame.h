// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/math.h"

namespace vernier {

/// Orthonormal right-handed basis; local z is the normal.
struct Frame {
  Vec3f x, y, z;

  Vec3f to_local(const Vec3f& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3f to_world(const Vec3f& v) const { return v.x * x + v.y * y + v.z * z; }

  /// Frame about the unit vector n, tangents arbitrary but continuous except at n.z = -0
  /// (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1), listing 3).
  static Frame from_normal(const Vec3f& n) {
    const float sign = std::copysign(1.f, n.z);
    const float a = -1 / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }

  /// Frame about n whose x axis lies in the half-plane of t; as from_normal when t is parallel to n or zero.
  static Frame from_normal_tangent(const Vec3f& n, const Vec3f& t) {
    const Vec3f once = t - dot(t, n) * n;
    // Once more: what rounding left along n is not small beside a t that is nearly parallel to n.
    const Vec3f projected = once - dot(once, n) * n;
    const float length2 = length_squared(projected);
    if (!(length2 > 1e-12f * length_squared(t))) return from_normal(n);
    const Vec3f x = projected * (1 / std::sqrt(length2));
    return {x, cross(n, x), n};
  }
};

}  // namespace vernier
