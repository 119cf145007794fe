// SPDX-License-Identifier: Apache-2.0
#include "vernier/ground.h"

#include "scene/subject.h"
#include "tests/support/test_scenes.h"

namespace vernier::test {
namespace {

TEST(Ground, LiesUnderTheSubjectAndIsNoPartOfIt) {
  SceneDescription description =
      SceneBuilder()
          .add(sphere({3, 2, -1}, 1, 12, 24), diffuse(0.5f))
          .add(parallelogram({-500, -7, 500}, {1000, 0, 0}, {0, 0, -1000}), diffuse(0.5f))  // a setting
          .description();
  add_ground(description);
  const Scene scene(std::move(description), {});
  EXPECT_EQ(Subject(scene.geometry()).bounds().lower.y, 1);
  for (const float x : {5.f, 60.f}) {
    const auto hit = scene.intersect(ray_through({x, 10, 0}, {x, 0, 0}));
    ASSERT_TRUE(hit);
    EXPECT_LT(hit->position.y, 1);
    EXPECT_GT(hit->position.y, 0.999f);
    EXPECT_TRUE(hit->front);
  }
  const auto identity = scene.identity();
  EXPECT_NE(
      std::find(identity.begin(), identity.end(), std::pair<std::string, std::string>("ground", "matte")),
      identity.end());
}

TEST(Ground, NeedsSomethingToStandOnIt) {
  SceneDescription description;
  add_ground(description);
  EXPECT_TRUE(description.instances.empty());
}

}  // namespace
}  // namespace vernier::test
