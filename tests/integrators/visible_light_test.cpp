// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/visible_light.h"

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "scene/camera.h"
#include "tests/support/test_scenes.h"

namespace vernier::test {
namespace {

constexpr int size = 100;

/// From four metres before the origin, looking at it.
Camera camera() {
  CameraDescription description;
  description.yfov = 0.8f;
  description.to_world.origin = {0, 0, 4};
  return {description, size, size};
}

VisibleLight seen(const Scene& scene) { return visible_light(scene, camera(), size, size); }

/// A grey body that fills most of the picture.
SceneBuilder body() {
  SceneBuilder builder;
  builder.add(sphere({0, 0, 0}, 1.2f, 32, 64), diffuse(0.5f));
  return builder;
}

PunctualLightDescription lamp(PunctualLightDescription::Kind kind, float intensity, const Vec3f& at) {
  PunctualLightDescription light;
  light.kind = kind;
  light.intensity = intensity;
  light.to_world.origin = at;
  return light;
}

TEST(VisibleLight, ABodyWithoutLightIsDark) {
  const VisibleLight light = seen(body().build());
  EXPECT_EQ(light.lit, 0);
  EXPECT_EQ(light.shown, 0);
  EXPECT_TRUE(is_dark(light));
}

TEST(VisibleLight, AGlowingDisplayLeavesItsModelDark) {
  SceneBuilder builder = body();
  builder.add(parallelogram({-0.3f, -0.2f, 1.25f}, {0.6f, 0, 0}, {0, 0.4f, 0}), emitter(5));
  const VisibleLight light = seen(builder.build());
  EXPECT_TRUE(is_dark(light)) << light.lit << " " << light.shown;
  EXPECT_GT(light.shown, 0);
}

TEST(VisibleLight, APanelBehindABodyLeavesItDark) {
  SceneBuilder builder = body();
  builder.add(parallelogram({2.5f, 1.5f, -1.5f}, {0, 0, 1}, {0, 1, 0}), emitter(50));
  const VisibleLight light = seen(builder.build());
  EXPECT_GT(light.lit, 0.1f);
  EXPECT_TRUE(is_dark(light)) << light.lit;
}

TEST(VisibleLight, ASpotOnAStageIsEnough) {
  SceneBuilder builder = body();
  PunctualLightDescription spot = lamp(PunctualLightDescription::Kind::spot, 10, {0, 0, 4});
  spot.inner_cone = 0.1f;
  spot.outer_cone = 0.12f;
  builder.add(spot);
  const VisibleLight light = seen(builder.build());
  EXPECT_LT(light.lit, 0.3f);
  EXPECT_FALSE(is_dark(light)) << light.lit;
}

TEST(VisibleLight, ALampInTheNightIsEnough) {
  SceneBuilder builder = body();
  builder.add(lamp(PunctualLightDescription::Kind::spot, 10, {0, 0, 4}));
  EXPECT_FALSE(is_dark(seen(builder.build())));
  // From the side, so that two thirds of what is seen stay black.
  builder = body();
  builder.add(lamp(PunctualLightDescription::Kind::point, 20, {4, 0, 1}));
  const VisibleLight light = seen(builder.build());
  EXPECT_LT(light.lit, 0.6f);
  EXPECT_FALSE(is_dark(light));
}

TEST(VisibleLight, ALampTooWeakToSeeByIsNot) {
  SceneBuilder builder = body();
  builder.add(lamp(PunctualLightDescription::Kind::point, 1e-3f, {0, 0, 4}));
  EXPECT_TRUE(is_dark(seen(builder.build())));
}

TEST(VisibleLight, BlackBodiesInTheLightAreNotDark) {
  SceneBuilder builder;
  builder.add(sphere({0, 0, 0}, 1.2f, 32, 64), diffuse(0.01f));
  builder.add(lamp(PunctualLightDescription::Kind::point, 10, {0, 0, 4}));
  EXPECT_FALSE(is_dark(seen(builder.build())));
}

TEST(VisibleLight, AModelWhoseColoursAreEmittedNeedsNoLight) {
  const Scene scene = SceneBuilder().add(sphere({0, 0, 0}, 1.2f, 32, 64), emitter(0.5f)).build();
  const VisibleLight light = seen(scene);
  EXPECT_EQ(light.shown, 1);
  EXPECT_FALSE(is_dark(light));
}

TEST(VisibleLight, ABlackEnvironmentIsNoLight) {
  EXPECT_TRUE(is_dark(seen(body().environment([](const Vec3f&) { return 0.f; }, 8).build())));
  EXPECT_FALSE(is_dark(seen(body().environment([](const Vec3f&) { return 0.3f; }, 8).build())));
}

TEST(VisibleLight, DoesNotDependOnThreads) {
  SceneBuilder builder = body();
  builder.add(parallelogram({-3, 3, -2}, {1, 0, 0}, {0, 0, 1}), emitter(5));
  const Scene scene = builder.build();
  const VisibleLight all = seen(scene);
  const ThreadLimit limit(1);
  const VisibleLight one = seen(scene);
  EXPECT_EQ(all.lit, one.lit);
  EXPECT_EQ(all.shown, one.shown);
}

TEST(VisibleLight, SurroundingsCanBeReplaced) {
  Scene scene = body().environment([](const Vec3f&) { return 0.f; }, 8).build();
  auto bright = std::make_shared<EnvironmentDescription>();
  auto picture = std::make_shared<Image>(1, 1, 3);
  picture->values = {1, 1, 1};
  bright->picture = picture;
  scene.set_environment(bright);
  EXPECT_EQ(scene.lights().size(), 1u);
  EXPECT_EQ(seen(scene).lit, 1);
}

// All that is seen is lit by a lamp in glass.
TEST(VisibleLight, CausticsOfALampAreEnough) {
  SceneBuilder builder = body();
  builder.add(sphere({0, 0, 8}, 2.f, 16, 32), glass(0))
      .add(lamp(PunctualLightDescription::Kind::point, 50, {0, 0, 8}));
  const VisibleLight light = seen(builder.build());
  EXPECT_FALSE(is_dark(light)) << light.lit << " " << light.shown;
}

}  // namespace
}  // namespace vernier::test
