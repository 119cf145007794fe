// SPDX-License-Identifier: Apache-2.0
#include "scene/camera.h"

#include <gtest/gtest.h>

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
  for (const auto kind : {CameraDescription::Kind::perspective, CameraDescription::Kind::orthographic}) {
    const Camera camera(turned(kind), 1920, 817);
    for (int i = 0; i < 1000; ++i) {
      const Vec2f u = random.next2(), raster(u.x * 1920, u.y * 817);
      const Ray ray = camera.ray(raster);
      EXPECT_NEAR(length(ray.direction), 1, 1e-6);
      const auto back = camera.project(ray.at(0.5f + 20 * random.next1()));
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->x, raster.x, 1e-3);
      EXPECT_NEAR(back->y, raster.y, 1e-3);
    }
    EXPECT_FALSE(camera.project(camera.ray({960, 400}).at(-1)));
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

}  // namespace
}  // namespace vernier::test
