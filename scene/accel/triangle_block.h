// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/simd.h"
#include "scene/accel/triangle.h"

namespace vernier {

/// Four triangles, tested at once. A block with fewer repeats its last.
struct alignas(64) TriangleBlock {
  static constexpr unsigned lanes = 4;
  Float4 vertex[3][3];  ///< [vertex][axis]
  uint32_t instance[lanes], primitive[lanes];
};

/// Of four triangles, sheared.
struct Corner4 {
  Float4 x, y, z;
};

struct BlockHits {
  Float4 t, u, v;
};

/// The ways to test a block: Ray is made once a query, test() returns the lanes hit with t in (t_min, t_max],
/// as bits. The interval is closed above so that of equal hits the caller can choose.
struct WatertightTest {
  using Ray = ShearedRay;
  static unsigned test(const TriangleBlock& block, const Ray& ray, float t_min, float t_max, BlockHits& hits);
};

struct MoellerTrumboreTest {
  struct Ray {
    Vec3f origin, direction;
    Ray(const Vec3f& o, const Vec3f& d) : origin(o), direction(d) {}
  };
  static unsigned test(const TriangleBlock& block, const Ray& ray, float t_min, float t_max, BlockHits& hits);
};

/// ShearedTriangle::hit() lane by lane.
inline unsigned weigh(const Corner4& a, const Corner4& b, const Corner4& c, double dz, BlockHits& hits) {
  const Double4 ax = widened(a.x), ay = widened(a.y), bx = widened(b.x), by = widened(b.y), cx = widened(c.x),
                cy = widened(c.y);
  const Double4 u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax, det = u + v + w;
  const Double4 inverse = 1 / (det * dz), inv_det = inverse * dz;
  hits.t = narrowed((u * widened(a.z) + v * widened(b.z) + w * widened(c.z)) * inverse);
  hits.u = narrowed(v * inv_det);
  hits.v = narrowed(w * inv_det);
  const DoubleMask4 positive = (u >= 0) & (v >= 0) & (w >= 0), negative = (u <= 0) & (v <= 0) & (w <= 0);
  const DoubleMask4 inside = (positive | negative) & (det != 0);
  return lane_bits(inside);
}

/// intersect_watertight() lane by lane, to the bit.
inline unsigned WatertightTest::test(const TriangleBlock& block, const Ray& ray, float t_min, float t_max,
                                     BlockHits& hits) {
  const float ox = ray.origin[ray.kx], oy = ray.origin[ray.ky], oz = ray.origin[ray.kz];
  const Float4 az = block.vertex[0][ray.kz] - oz, bz = block.vertex[1][ray.kz] - oz,
               cz = block.vertex[2][ray.kz] - oz;
  const Float4 ax = (block.vertex[0][ray.kx] - ox) - ray.sx * az,
               ay = (block.vertex[0][ray.ky] - oy) - ray.sy * az;
  const Float4 bx = (block.vertex[1][ray.kx] - ox) - ray.sx * bz,
               by = (block.vertex[1][ray.ky] - oy) - ray.sy * bz;
  const Float4 cx = (block.vertex[2][ray.kx] - ox) - ray.sx * cz,
               cy = (block.vertex[2][ray.ky] - oy) - ray.sy * cz;
  const Float4 u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  // Where products overflow, nothing is outside yet.
  const Mask4 outside = ((u > 0) | (v > 0) | (w > 0)) & ((u < 0) | (v < 0) | (w < 0));
  if (lane_bits(~outside) == 0) return 0;
  return weigh({ax, ay, az}, {bx, by, bz}, {cx, cy, cz}, ray.dz, hits) &
         lane_bits((hits.t > t_min) & (hits.t <= t_max));
}

/// intersect_moeller_trumbore() lane by lane, to the bit.
inline unsigned MoellerTrumboreTest::test(const TriangleBlock& block, const Ray& ray, float t_min,
                                          float t_max, BlockHits& hits) {
  const Vec3f &o = ray.origin, &d = ray.direction;
  const auto& v0 = block.vertex[0];
  const Float4 e1x = block.vertex[1][0] - v0[0], e1y = block.vertex[1][1] - v0[1],
               e1z = block.vertex[1][2] - v0[2];
  const Float4 e2x = block.vertex[2][0] - v0[0], e2y = block.vertex[2][1] - v0[1],
               e2z = block.vertex[2][2] - v0[2];
  const Float4 sx = o.x - v0[0], sy = o.y - v0[1], sz = o.z - v0[2];
  const Float4 px = d.y * e2z - d.z * e2y, py = d.z * e2x - d.x * e2z, pz = d.x * e2y - d.y * e2x;
  const Float4 qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
  const Float4 det = px * e1x + py * e1y + pz * e1z;
  const Float4 inv_det = 1 / det;
  hits.u = (px * sx + py * sy + pz * sz) * inv_det;
  hits.v = (qx * d.x + qy * d.y + qz * d.z) * inv_det;
  hits.t = (qx * e2x + qy * e2y + qz * e2z) * inv_det;
  return lane_bits((det != 0) & (hits.u >= 0) & (hits.v >= 0) & (hits.u + hits.v <= 1) & (hits.t > t_min) &
                   (hits.t <= t_max));
}

}  // namespace vernier
