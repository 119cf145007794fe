// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/instance.h"

#include <algorithm>

#include "core/math/rounding.h"

namespace vernier {

/// A carried ray is then off by less than 2^-14 of its distance.
constexpr double largest_distortion = 1 << 9;

std::optional<WorldToMesh> WorldToMesh::of(const Transform& to_world) {
  const Vec3d a(to_world.x), b(to_world.y), c(to_world.z);
  const double det = dot(a, cross(b, c));
  // Rows of the inverse are the cross products of the columns over the determinant (Cramer's rule).
  const Vec3d r0 = cross(b, c) / det, r1 = cross(c, a) / det, r2 = cross(a, b) / det;
  const WorldToMesh inverse{
      {r0.x, r1.x, r2.x},
      {r0.y, r1.y, r2.y},
      {r0.z, r1.z, r2.z},
      {-dot(r0, Vec3d(to_world.origin)), -dot(r1, Vec3d(to_world.origin)), -dot(r2, Vec3d(to_world.origin))}};
  if (det == 0 || !is_finite(to_world.origin)) return {};
  for (const Vec3d* column : {&inverse.x, &inverse.y, &inverse.z, &inverse.origin})
    if (!is_finite(Vec3f(*column))) return {};
  if (!(inverse.distortion(to_world) <= largest_distortion)) return {};
  return inverse;
}

double WorldToMesh::distortion(const Transform& to_world) const {
  double largest = 0;
  for (int row = 0; row < 3; ++row) {
    const Vec3d m(std::abs(to_world.x[row]), std::abs(to_world.y[row]), std::abs(to_world.z[row]));
    double sum = 0;
    for (const Vec3d* column : {&x, &y, &z}) sum += dot(m, abs(*column));
    largest = std::max(largest, sum);
  }
  return largest;
}

std::vector<Vec3f> bake_positions(const GeometryMesh& mesh, const Transform& to_world) {
  const Vec3d x(to_world.x), y(to_world.y), z(to_world.z), origin(to_world.origin);
  std::vector<Vec3f> baked;
  baked.reserve(mesh.positions.size() + 2);
  for (const Vec3f& p : mesh.positions)
    baked.emplace_back(x * double(p.x) + y * double(p.y) + z * double(p.z) + origin);
  baked.resize(mesh.positions.size() + 2);  // 24 readable bytes past the last position
  return baked;
}

Bounds transformed_box(const Bounds& box, const Transform& to_world) {
  Bounds world;
  if (box.empty()) return world;
  const Vec3d x(to_world.x), y(to_world.y), z(to_world.z), origin(to_world.origin);
  for (int corner = 0; corner < 8; ++corner) {
    const double px = corner & 1 ? box.upper.x : box.lower.x;
    const double py = corner & 2 ? box.upper.y : box.lower.y;
    const double pz = corner & 4 ? box.upper.z : box.lower.z;
    world.add(Vec3f(x * px + y * py + z * pz + origin));
  }
  for (int axis = 0; axis < 3; ++axis) {
    world.lower[axis] = next_float_down(world.lower[axis]);
    world.upper[axis] = next_float_up(world.upper[axis]);
  }
  return world;
}

}  // namespace vernier
