// SPDX-License-Identifier: Apache-2.0
#include "core/math/frame.h"
#include "scene/geometry.h"

namespace vernier {

/// A square about the ray meets the plane of the triangle in a rectangle, as much longer as it is oblique
/// (Akenine-Möller, Crassin, Boksansky, Belcour, Panteleev and Wright 2021, "Improved Shader and Texture
/// Level of Detail Using Ray Cones", section 3).
void SceneGeometry::add_footprint(SurfaceAttributes& attributes, const SurfacePoint& point,
                                  const Vec3f& w) const {
  const Instance& placed = instances_[point.instance];
  auto [p0, p1, p2] = mesh_triangle(point.instance, point.primitive);
  if (placed.moves) {
    const auto corners = triangle(point.instance, point.primitive, point.time);
    p0 = corners[0], p1 = corners[1], p2 = corners[2];
  }
  const Vec3f e1 = placed.to_world.vector(p1 - p0), e2 = placed.to_world.vector(p2 - p0);
  const Vec3f n = cross(e1, e2);
  const float n2 = length_squared(n), cosine = std::abs(dot(w, point.ng));
  if (!(n2 > 0 && cosine > 0)) return;
  const Frame frame = Frame::from_normal_tangent(point.ng, w);
  const auto in_barycentrics = [&](const Vec3f& side) {
    return Vec2f(dot(cross(side, e2), n) / n2, dot(cross(e1, side), n) / n2);
  };
  attributes.has_footprint = true;
  attributes.footprint = {in_barycentrics(frame.x * (point.footprint / cosine)),
                          in_barycentrics(frame.y * point.footprint)};
  attributes.mesh = &meshes_[placed.mesh];
  attributes.triangle = point.primitive;
  attributes.barycentrics = {point.u, point.v};
}

}  // namespace vernier
