// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "vernier/export.h"
#include "vernier/math.h"

namespace vernier {

/// Affine map p -> x p.x + y p.y + z p.z + origin (columns of the linear part, then the translation), metres.
struct Transform {
  Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{0, 0, 0};

  Vec3f point(const Vec3f& p) const { return x * p.x + y * p.y + z * p.z + origin; }
  Vec3f vector(const Vec3f& v) const { return x * v.x + y * v.y + z * v.z; }

  /// Product of the transposed linear part with n: maps normals of the image space back, and, on an inverse,
  /// normals forward. Not normalized.
  Vec3f transposed_vector(const Vec3f& n) const { return {dot(x, n), dot(y, n), dot(z, n)}; }

  /// |linear part| v + |origin| factor, component-wise absolute values: carries rounding-error bounds through
  /// point().
  Vec3f absolute_point(const Vec3f& v, float origin_factor) const {
    return abs(x) * v.x + abs(y) * v.y + abs(z) * v.z + abs(origin) * origin_factor;
  }

  double determinant() const { return dot(Vec3d(x), cross(Vec3d(y), Vec3d(z))); }

  bool is_identity() const { return *this == Transform{}; }
  bool operator==(const Transform&) const = default;

  /// Computed in double; empty when the linear part is singular or not finite.
  VERNIER_API std::optional<Transform> inverse() const;
};

}  // namespace vernier
