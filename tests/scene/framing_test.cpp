// SPDX-License-Identifier: Apache-2.0
#include "scene/framing.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/math/frame.h"
#include "scene/camera.h"
#include "tests/support/random.h"

namespace vernier::test {
namespace {

constexpr int height = 1000;

std::vector<Vec3f> random_points(Random& random, size_t count) {
  const Vec3f center(100 * random.next1(), -30 * random.next1(), 7);
  const Vec3f size(0.1f + 5 * random.next1(), 0.1f + 5 * random.next1(), 0.1f + 5 * random.next1());
  std::vector<Vec3f> points;
  for (size_t i = 0; i < count; ++i) {
    const Vec3f unit(random.next1(), random.next1(), random.next1());
    points.push_back(center + unit * size);
  }
  return points;
}

FarthestPoint farthest_of(const std::vector<Vec3f>& points) {
  return [&points](const Vec3f& direction) {
    return *std::max_element(points.begin(), points.end(), [&](const Vec3f& a, const Vec3f& b) {
      return dot(a, direction) < dot(b, direction);
    });
  };
}

CameraDescription looking(Random& random, CameraDescription::Kind kind) {
  const Vec2f u = random.next2();
  const float z = 1 - 2 * u.x, around = 2 * pi * u.y;
  const Frame frame = Frame::from_normal(
      {safe_sqrt(1 - z * z) * std::cos(around), safe_sqrt(1 - z * z) * std::sin(around), z});
  CameraDescription camera;
  camera.kind = kind;
  camera.yfov = 0.2f + random.next1();
  camera.to_world = {frame.x, frame.y, frame.z, {0, 0, 0}};
  return camera;
}

/// Room left at each side of the picture, as parts of its width and height.
struct Room {
  float left = 1, right = 1, top = 1, bottom = 1;
};
Room room_around(const std::vector<Vec3f>& points, const CameraDescription& description, float aspect) {
  const Camera camera(description, int(height * aspect), height);
  Room room;
  for (const Vec3f& p : points) {
    const auto at = camera.project(p);
    if (!at) return {-1, -1, -1, -1};
    const float x = at->x / (height * aspect), y = at->y / height;
    room = {std::min(room.left, x), std::min(room.right, 1 - x), std::min(room.top, y),
            std::min(room.bottom, 1 - y)};
  }
  return room;
}

TEST(Framing, RandomBodiesTouchTheMarginAndAreCentred) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto kind =
        trial % 4 == 0 ? CameraDescription::Kind::orthographic : CameraDescription::Kind::perspective;
    const auto points = random_points(random, 2 + size_t(trial) % 40);
    const float aspect = trial % 3 == 0 ? 0.5f : trial % 3 == 1 ? 1.f : 2.25f;
    const float margin = 0.2f * random.next1();
    const auto camera = fit_camera(looking(random, kind), farthest_of(points), aspect, margin);
    const Room room = room_around(points, camera, aspect);
    EXPECT_NEAR(std::min({room.left, room.right, room.top, room.bottom}), margin, 0.002f) << trial;
    EXPECT_NEAR(room.left, room.right, 0.002f) << trial;
    EXPECT_NEAR(room.top, room.bottom, 0.002f) << trial;
  }
}

TEST(Framing, TheCameraIsMovedButNotTurned) {
  Random random(2);
  const auto points = random_points(random, 10);
  const CameraDescription before = looking(random, CameraDescription::Kind::perspective);
  const CameraDescription after = fit_camera(before, farthest_of(points), 1.5f, 0.1f);
  EXPECT_EQ(after.yfov, before.yfov);
  EXPECT_NEAR(length(after.to_world.x - before.to_world.x), 0, 1e-6);
  EXPECT_NEAR(length(after.to_world.z - before.to_world.z), 0, 1e-6);
}

TEST(Framing, AHouseInSurveyCoordinatesFillsItsPicture) {
  // Five thousand kilometres out, single precision has steps of half a metre.
  const Vec3f place(512345, 120, -5412345);
  std::vector<Vec3f> points(8, place);
  for (size_t i = 0; i < 8; ++i) points[i] += Vec3f(i & 1 ? 12.f : 0.f, i & 2 ? 6.f : 0.f, i & 4 ? 8.f : 0.f);
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const auto camera =
        fit_camera(looking(random, CameraDescription::Kind::perspective), farthest_of(points), 1.5f, 0.08f);
    const Room room = room_around(points, camera, 1.5f);
    EXPECT_NEAR(std::min({room.left, room.right, room.top, room.bottom}), 0.08f, 0.04f) << trial;
  }
}

TEST(Framing, APointAndALineSeenEndOnLieBeforeTheCamera) {
  for (const auto kind : {CameraDescription::Kind::perspective, CameraDescription::Kind::orthographic})
    for (const float length : {0.f, 3.f}) {
      const std::vector<Vec3f> points{{5, 5, 5}, {5, 5, 5 - length}};
      CameraDescription camera;
      camera.kind = kind;
      const auto fitted = fit_camera(camera, farthest_of(points), 1, 0.08f);
      const Room room = room_around(points, fitted, 1);
      EXPECT_NEAR(room.left, 0.5f, 0.01f);
      EXPECT_NEAR(room.bottom, 0.5f, 0.01f);
    }
}

}  // namespace
}  // namespace vernier::test
