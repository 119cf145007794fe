// SPDX-License-Identifier: Apache-2.0
#include "scene/camera.h"

#include <gtest/gtest.h>

#include "core/math/frame.h"
#include "tests/support/random.h"

namespace vernier::test {
namespace {

CameraDescription turned(CameraDescription::Kind kind) {
  CameraDescription camera;
  camera.kind = kind;
  camera.yfov = 0.9f;
  camera.ymag = 2;
  // Scaled axes, as glTF allows: only their directions count.
  const float c = std::cos(0.7f), s = std::sin(0.7f);
  camera.to_world = {Vec3f(c, 0, -s) * 2, Vec3f(0, 1, 0) * 3, Vec3f(s, 0, c) * 0.5f, {3, -1, 2}};
  return camera;
}

TEST(Camera, ProjectUndoesRay) {
  Random random(5);
  using Kind = CameraDescription::Kind;
  for (const auto kind : {Kind::perspective, Kind::orthographic, Kind::panorama}) {
    const Camera camera(turned(kind), 1920, 817);
    for (int i = 0; i < 1000; ++i) {
      const Vec2f u = random.next2(), raster(u.x * 1920, 50 + u.y * 717);  // off the poles
      const Ray ray = camera.ray(raster);
      EXPECT_NEAR(length(ray.direction), 1, 1e-6);
      const auto back = camera.project(ray.at(0.5f + 20 * random.next1()));
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->x, raster.x, 1e-3);
      EXPECT_NEAR(back->y, raster.y, 1e-3);
    }
    EXPECT_EQ(camera.project(camera.ray({960, 400}).at(-1)).has_value(), kind == Kind::panorama);
  }
}

// Local -z in the middle, +y up, +x right; yfov is the whole vertical angle and pixels are square.
TEST(Camera, Orientation) {
  CameraDescription description;
  description.yfov = pi / 2;
  const Camera camera(description, 200, 100);
  const auto expect = [&](const Vec2f& raster, const Vec3f& direction) {
    EXPECT_LT(length(camera.ray(raster).direction - normalize(direction)), 1e-6f) << raster;
  };
  expect({100, 50}, {0, 0, -1});
  expect({100, 0}, {0, 1, -1});
  expect({100, 100}, {0, -1, -1});
  expect({200, 50}, {2, 0, -1});
  expect({0, 0}, {-2, 1, -1});

  const Camera flat(turned(CameraDescription::Kind::orthographic), 300, 100);
  EXPECT_LT(length(flat.ray({300, 0}).origin - flat.ray({0, 0}).origin) - 12, 1e-5f);
  EXPECT_LT(length(flat.ray({0, 100}).origin - flat.ray({0, 0}).origin) - 4, 1e-5f);
  EXPECT_EQ(flat.ray({0, 0}).direction, flat.ray({300, 100}).direction);
}

// As EnvironmentDescription has it: u = atan2(z, x) / 2pi + 1/2, v = acos(y) / pi.
TEST(Camera, PanoramasAreLaidOutAsEnvironments) {
  CameraDescription description;
  description.kind = CameraDescription::Kind::panorama;
  description.to_world.origin = {1, 2, 3};
  const Camera camera(description, 200, 100);
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const Vec2f u = random.next2();
    const Ray ray = camera.ray({u.x * 200, u.y * 100});
    EXPECT_EQ(ray.origin, description.to_world.origin);
    EXPECT_NEAR(std::atan2(ray.direction.z, ray.direction.x) / (2 * pi) + 0.5f, u.x,
                1e-4 / (u.y * (1 - u.y)));
    EXPECT_NEAR(std::acos(ray.direction.y) / pi, u.y, 1e-3);
    EXPECT_EQ(camera.depth(ray, 3), 3) << "along the ray";
  }
  // Beyond the upper end it goes on behind the pole.
  EXPECT_LT(length(camera.ray({70, -5}).direction - camera.ray({170, 5}).direction), 1e-5f);
}

TEST(Camera, RaysThroughALensMeetInTheFocusPlane) {
  CameraDescription description = turned(CameraDescription::Kind::perspective);
  EXPECT_FALSE(Camera(description, 640, 480).has_lens());
  description.lens_radius = 0.2f;
  description.focus_distance = 3;
  const Camera camera(description, 640, 480);
  ASSERT_TRUE(camera.has_lens());
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const Vec2f u = random.next2(), raster(u.x * 640, u.y * 480), on_lens = random.next2() * 2 - Vec2f(1, 1);
    const Ray axial = camera.ray({320, 240}), center = camera.ray(raster), ray = camera.ray(raster, on_lens);
    const auto at_focus = [&](const Ray& r) { return r.at(3 / dot(r.direction, axial.direction)); };
    EXPECT_LT(length(at_focus(ray) - at_focus(center)), 1e-5f);
    EXPECT_NEAR(length(ray.origin - description.to_world.origin), 0.2f * on_lens.length(), 1e-6);
    EXPECT_NEAR(dot(ray.origin - description.to_world.origin, axial.direction), 0, 1e-6);
    EXPECT_NEAR(length(ray.direction), 1, 1e-6);
    EXPECT_NEAR(camera.depth(center, 2), 2 * dot(center.direction, axial.direction), 1e-6);
  }
  description.focus_distance = std::numeric_limits<float>::infinity();
  const Camera far_off(description, 640, 480);
  EXPECT_LT(length(far_off.ray({50, 60}, {0.3f, 0.4f}).direction - far_off.ray({50, 60}).direction), 1e-6f);
}

// The pixels' solid angles add up to that of the picture, 4 asin(a b / sqrt((1 + a^2)(1 + b^2))).
TEST(Camera, SolidAngle) {
  CameraDescription description;
  description.yfov = 0.8f;
  constexpr int width = 160, height = 90;
  const Camera camera(description, width, height);
  double sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      // Two triangles of unit directions each (Van Oosterom and Strackee 1983).
      const auto corner = [&](int i, int j) {
        return Vec3d(camera.ray({float(x + i), float(y + j)}).direction);
      };
      const auto solid_angle = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        return 2 * std::atan2(std::abs(dot(a, cross(b, c))), 1 + dot(a, b) + dot(b, c) + dot(c, a));
      };
      sum += solid_angle(corner(0, 0), corner(1, 0), corner(1, 1)) +
             solid_angle(corner(0, 0), corner(1, 1), corner(0, 1));
    }
  const double b = std::tan(0.4), a = b * width / height;
  EXPECT_NEAR(sum, 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b))), 1e-4);
}

// A point's sight is the ray through it, and its area what the raster positions of points beside it span, on
// a surface that faces the ray.
TEST(Camera, SightIsTheRayAndItsDensity) {
  Random random(6);
  using Kind = CameraDescription::Kind;
  for (const auto kind : {Kind::perspective, Kind::orthographic, Kind::panorama})
    for (const float lens : {0.f, 0.1f}) {
      if (lens > 0 && kind != Kind::perspective) continue;
      CameraDescription description = turned(kind);
      description.lens_radius = lens;
      description.focus_distance = 4;
      const Camera camera(description, 640, 400);
      for (int i = 0; i < 300; ++i) {
        const Vec2f u = random.next2(), on_lens = (random.next2() - Vec2f(0.5f, 0.5f)) * 1.2f;
        const Vec2f raster(20 + u.x * 600, 60 + u.y * 280);
        const Ray ray = lens > 0 ? camera.ray(raster, on_lens) : camera.ray(raster);
        const Vec3f at = ray.at(1 + 5 * random.next1());
        const auto sight = camera.sight(at, on_lens, middle_of_shutter);
        ASSERT_TRUE(sight);
        EXPECT_LT(length(sight->origin - ray.origin), 1e-5f);
        EXPECT_LT(length(Vec3f(sight->raster.x - raster.x, sight->raster.y - raster.y, 0)), 5e-3f);
        const Frame frame = Frame::from_normal(ray.direction);
        const float step = 0.02f;
        const auto beside = [&](const Vec3f& way) {
          return camera.sight(at + way * step, on_lens, middle_of_shutter)->raster;
        };
        const Vec2f x = (beside(frame.x) - beside(-frame.x)) / (2 * step);
        const Vec2f y = (beside(frame.y) - beside(-frame.y)) / (2 * step);
        EXPECT_NEAR(std::abs(x.x * y.y - x.y * y.x), sight->area, 5e-3f * sight->area);
      }
    }
}

}  // namespace
}  // namespace vernier::test
