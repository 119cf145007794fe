// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "core/math/ray.h"
#include "vernier/math.h"

// Two tests of a ray against one triangle. Both sides count, and u, v weigh the second and third vertex as in
// Embree. They do not look at the ray's interval: the caller compares t.

namespace vernier {

struct TriangleHit {
  float t, u, v;
};

/// Moeller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), eq. 6. Rays aimed
/// at an edge may slip between the two triangles that share it.
inline std::optional<TriangleHit> intersect_moeller_trumbore(const Ray& ray, const Vec3f& v0, const Vec3f& v1,
                                                             const Vec3f& v2) {
  const Vec3f e1 = v1 - v0, e2 = v2 - v0, s = ray.origin - v0;
  const Vec3f p = cross(ray.direction, e2), q = cross(s, e1);
  const float det = dot(p, e1);
  if (det == 0) return {};
  const float inv_det = 1 / det;
  const float u = dot(p, s) * inv_det, v = dot(q, ray.direction) * inv_det;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return {};
  return TriangleHit{dot(q, e2) * inv_det, u, v};
}

/// A ray as the watertight test sees it: the direction's largest axis is kz, and a shear along it makes the
/// ray a line of constant x = y = 0.
struct ShearedRay {
  Vec3f origin;
  int kx, ky, kz;
  float sx, sy, dz;

  ShearedRay(const Vec3f& o, const Vec3f& d) : origin(o) {
    const Vec3f size = abs(d);
    kz = size.y > size.x;
    kz = size.z > size[kz] ? 2 : kz;
    kx = kz == 2 ? 0 : kz + 1;
    ky = kx == 2 ? 0 : kx + 1;
    dz = d[kz];
    sx = d[kx] / dz;
    sy = d[ky] / dz;
  }
};

/// The sheared vertices of a triangle.
struct ShearedTriangle {
  Vec3f a, b, c;

  /// Where (0, 0) lies in the projected triangle, and the depth there over dz; empty when it is outside. In
  /// double, where the products of floats are exact: so the signs of the edge functions are those of the real
  /// numbers, and the weights of a sliver's far corners do not drown the depth between them.
  std::optional<TriangleHit> hit(float dz) const {
    const auto edge = [](const Vec3f& p, const Vec3f& q) { return double(p.x) * q.y - double(p.y) * q.x; };
    const double u = edge(c, b), v = edge(a, c), w = edge(b, a), det = u + v + w;
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || det == 0) return {};
    const double inverse = 1 / (det * dz), inv_det = inverse * dz;
    return TriangleHit{float((u * a.z + v * b.z + w * c.z) * inverse), float(v * inv_det),
                       float(w * inv_det)};
  }
};

/// Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1). The vertices are sheared into
/// the ray's frame, each by the same operations whichever triangle it belongs to; after that the edge
/// functions have exact signs: the rounded products of a float difference compare as the exact ones do or
/// equal, and then double decides. So of the triangles around an edge or vertex that the ray meets from one
/// side, at least one is hit. Departures from the paper: both sides count, and what is hit is weighed in
/// double. triangle_block.h has the same operations on four triangles.
inline std::optional<TriangleHit> intersect_watertight(const ShearedRay& ray, const Vec3f& v0,
                                                       const Vec3f& v1, const Vec3f& v2) {
  const float ox = ray.origin[ray.kx], oy = ray.origin[ray.ky], oz = ray.origin[ray.kz];
  const auto sheared = [&](const Vec3f& v) {
    const float z = v[ray.kz] - oz;
    return Vec3f((v[ray.kx] - ox) - ray.sx * z, (v[ray.ky] - oy) - ray.sy * z, z);
  };
  return ShearedTriangle{sheared(v0), sheared(v1), sheared(v2)}.hit(ray.dz);
}

/// Whether rays can hit the triangle at all: finite vertices and an area. The products are exact unless
/// coordinates differ by more than 2^29 in size.
inline bool is_hittable(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2) {
  if (!is_finite(v0) || !is_finite(v1) || !is_finite(v2)) return false;
  const Vec3d n = cross(Vec3d(v1) - Vec3d(v0), Vec3d(v2) - Vec3d(v0));
  return n.x != 0 || n.y != 0 || n.z != 0;
}

}  // namespace vernier
