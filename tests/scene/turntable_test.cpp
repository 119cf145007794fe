// SPDX-License-Identifier: Apache-2.0
#include "scene/turntable.h"

#include <gtest/gtest.h>

#include "scene/camera.h"
#include "tests/support/random.h"

namespace vernier::test {
namespace {

/// Triangles here and there in a box that is far from the origin.
std::vector<MeshDescription> random_mesh(Random& random) {
  MeshDescription mesh;
  for (uint32_t i = 0; i < 60; ++i) {
    mesh.positions.emplace_back(7 + 3 * random.next1(), -2 + random.next1(), 1 + 2 * random.next1());
    if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
  }
  return {mesh};
}

TEST(Turntable, TheSubjectFillsThePictureUpToTheMarginOverAWholeTurn) {
  Random random(5);
  constexpr int height = 900, steps = 720;
  for (const float aspect : {0.5f, 1.5f})
    for (const float elevation : {-0.4f, 0.f, 1.2f}) {
      const auto meshes = random_mesh(random);
      const SceneGeometry geometry(meshes, {InstanceDescription{}});
      const Subject subject(geometry);
      FittedView view;
      view.elevation = elevation;
      const CameraDescription base = fitted_turntable_camera(subject, aspect, view);
      float room = 1;
      for (int step = 0; step < steps; ++step) {
        const Camera camera(carried_around(base, subject.bounds().center(), 2.0 * pi * step / steps),
                            int(height * aspect), height);
        for (const Vec3f& p : meshes[0].positions) {
          const auto at = camera.project(p);
          ASSERT_TRUE(at);
          const float x = at->x / (height * aspect), y = at->y / height;
          room = std::min({room, x, 1 - x, y, 1 - y});
        }
      }
      EXPECT_NEAR(room, view.margin, 2e-3f) << aspect << ' ' << elevation;
    }
}

TEST(Turntable, CarriesTheCameraTowardGrowingAzimuths) {
  CameraDescription camera;
  camera.to_world.origin = {3, 5, 9};
  const Transform quarter = carried_around(camera, {3, 0, 7}, pi / 2).to_world;
  EXPECT_NEAR(length(quarter.origin - Vec3f(5, 5, 7)), 0, 1e-6f);
  EXPECT_NEAR(length(quarter.z - Vec3f(1, 0, 0)), 0, 1e-6f);
  EXPECT_NEAR(length(quarter.x - Vec3f(0, 0, -1)), 0, 1e-6f);
  const Transform whole = carried_around(camera, {3, 0, 7}, 2.0 * pi).to_world;
  EXPECT_NEAR(length(whole.origin - camera.to_world.origin), 0, 1e-5f);
}

}  // namespace
}  // namespace vernier::test
