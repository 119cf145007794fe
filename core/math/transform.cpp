// SPDX-License-Identifier: Apache-2.0
#include "vernier/transform.h"

namespace vernier {

std::optional<Transform> Transform::inverse() const {
  const Vec3d a(x), b(y), c(z), o(origin);
  const Vec3d bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double det = dot(a, bc);
  if (!std::isfinite(det) || det == 0) return std::nullopt;
  // Rows of the inverse are bc, ca, ab over det.
  const Vec3d r0 = bc / det, r1 = ca / det, r2 = ab / det;
  Transform inv;
  inv.x = Vec3f(Vec3d(r0.x, r1.x, r2.x));
  inv.y = Vec3f(Vec3d(r0.y, r1.y, r2.y));
  inv.z = Vec3f(Vec3d(r0.z, r1.z, r2.z));
  inv.origin = Vec3f(Vec3d(-dot(r0, o), -dot(r1, o), -dot(r2, o)));
  if (!is_finite(inv.x) || !is_finite(inv.y) || !is_finite(inv.z) || !is_finite(inv.origin))
    return std::nullopt;
  return inv;
}

}  // namespace vernier
