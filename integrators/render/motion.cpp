// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/motion.h"

namespace vernier {

MotionFinder::MotionFinder(const Scene& scene, const Camera& camera, const Moments& moments, int width,
                           int height)
    : geometry_(scene.geometry()),
      camera_(camera),
      previous_{moments.previous.scene->geometry(), Camera(moments.previous.camera, width, height)},
      next_{moments.next.scene->geometry(), Camera(moments.next.camera, width, height)} {}

PixelMotion MotionFinder::at(const TriangleId& triangle, const Vec2f& barycentrics) const {
  // Not the pixel's centre, which is this to rounding: what stands still shall not move at all.
  const Vec3f point = geometry_.surface_point(triangle.instance, triangle.primitive, barycentrics).position;
  const auto here = camera_.project(point);
  if (!here) return {};
  return {motion_to(previous_, triangle, barycentrics, *here),
          motion_to(next_, triangle, barycentrics, *here)};
}

Vec2f MotionFinder::motion_to(const Other& other, const TriangleId& triangle, const Vec2f& barycentrics,
                              const Vec2f& here) const {
  const SceneGeometry& there = other.geometry;
  const auto [instance, primitive] = triangle;
  if (there.instance_count() != geometry_.instance_count() ||
      there.triangle_count(instance) != geometry_.triangle_count(instance))
    return {0, 0};
  const auto raster = other.camera.project(there.surface_point(instance, primitive, barycentrics).position);
  return raster ? Vec2f(raster->x - here.x, here.y - raster->y) : Vec2f(0, 0);
}

}  // namespace vernier
