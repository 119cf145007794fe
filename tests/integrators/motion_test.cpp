// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/motion.h"

#include <cmath>

#include "tests/support/test_scenes.h"
#include "vernier/error.h"

namespace vernier::test {
namespace {

constexpr int width = 40, height = 20;

CameraDescription camera_at(const Vec3f& eye) {
  CameraDescription camera;
  camera.yfov = 1;
  camera.to_world.origin = eye;
  return camera;
}

/// A wall two metres before the camera, this far to the right and up.
std::shared_ptr<const Scene> wall_at(float x, float y) {
  Transform to_world;
  to_world.origin = Vec3f(x, y, -2);
  SceneBuilder builder;
  builder.add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), diffuse(0.5f), to_world);
  return std::make_shared<const Scene>(builder.description(), SceneOptions());
}

LayeredImage motion(const std::shared_ptr<const Scene>& scene, const Moments& moments) {
  RenderSettings settings;
  settings.camera = camera_at({0, 0, 0});
  settings.width = width;
  settings.height = height;
  settings.limits.spp = 1;
  RenderSession session(scene, settings);
  session.set_moments(moments);
  return session.picture("motion");
}

/// Pixels of a metre at the wall.
double pixels_per_metre() { return height / (2 * 2 * std::tan(0.5)); }

void expect_motion(const LayeredImage& picture, const Vec2d& to_previous, const Vec2d& to_next) {
  const auto expect = [&](const char* channel, double value) {
    const Image image = *picture.single(channel);
    EXPECT_NEAR(*image.pixel(width / 2, height / 2), value, 1e-4) << channel;
    EXPECT_EQ(*image.pixel(0, 0), 0) << channel << " where nothing is met";
  };
  expect("Vector.X", to_previous.x);
  expect("Vector.Y", to_previous.y);
  expect("Vector.Z", -to_next.x);
  expect("Vector.W", -to_next.y);
  expect("backward.u", to_previous.x);
  expect("backward.v", to_previous.y);
  expect("forward.u", to_next.x);
  expect("forward.v", to_next.y);
}

TEST(Motion, OfAWallAcrossTheViewIsItsSpeedOverItsDistance) {
  const double k = pixels_per_metre();
  expect_motion(motion(wall_at(0, 0), {{wall_at(-0.1f, 0.02f), camera_at({0, 0, 0})},
                                       {wall_at(0.3f, 0.05f), camera_at({0, 0, 0})}}),
                Vec2d(-0.1, 0.02) * k, Vec2d(0.3, 0.05) * k);
}

TEST(Motion, OfACameraIsThatOfTheSceneTheOtherWay) {
  const double k = pixels_per_metre();
  const auto scene = wall_at(0, 0);
  expect_motion(motion(scene, {{scene, camera_at({0.1f, 0, 0})}, {scene, camera_at({0, -0.2f, 0})}}),
                Vec2d(-0.1, 0) * k, Vec2d(0, 0.2) * k);
}

TEST(Motion, OfWhatStandsStillIsExactlyZero) {
  const auto scene = wall_at(0.1f, 0.2f);
  const Moment same{wall_at(0.1f, 0.2f), camera_at({0, 0, 0})};
  const LayeredImage picture = motion(scene, {same, same});
  for (const char* channel : {"Vector.X", "Vector.Y", "Vector.Z", "Vector.W", "forward.u", "backward.v"})
    EXPECT_EQ(picture.single(channel)->values, std::vector<float>(size_t(width) * height, 0)) << channel;
}

TEST(Motion, OfWhatIsBehindTheOtherCameraOrMadeOfOtherTrianglesIsZero) {
  const auto scene = wall_at(0, 0);
  SceneBuilder more;
  more.add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), diffuse(0.5f));
  more.add(parallelogram({-1, -1, -3}, {2, 0, 0}, {0, 2, 0}), diffuse(0.5f));
  const auto other = std::make_shared<const Scene>(more.description(), SceneOptions());
  expect_motion(motion(scene, {{scene, camera_at({0, 0, -3})}, {other, camera_at({1, 0, 0})}}), Vec2d(0, 0),
                Vec2d(0, 0));
}

TEST(Motion, IsRefusedWhereNothingIsKnownOfOtherMoments) {
  RenderSettings settings;
  settings.width = settings.height = 4;
  settings.limits.spp = 1;
  const RenderSession session(wall_at(0, 0), settings);
  EXPECT_THROW(static_cast<void>(session.picture("motion")), Error);
  EXPECT_NO_THROW(static_cast<void>(session.picture("all")));
}

}  // namespace
}  // namespace vernier::test
