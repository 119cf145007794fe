// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/shadow.h"

#include <cmath>
#include <numbers>

#include "tests/support/test_scenes.h"
#include "vernier/session.h"

// The layer `shadow` against shadows that can be calculated.

namespace vernier::test {
namespace {

constexpr int size = 8;

PunctualLightDescription sun(float irradiance, const Vec3f& toward) {
  PunctualLightDescription light;
  light.kind = PunctualLightDescription::Kind::directional;
  light.intensity = irradiance;
  const Vec3f z = normalize(toward), x = normalize(cross(Vec3f(0, 1, 0.1f), z));
  light.to_world.x = x;
  light.to_world.y = cross(z, x);
  light.to_world.z = z;
  return light;
}

/// A floor at z = 0 that the camera looks at from above, where nothing else is in its way.
SceneBuilder floor_seen_from_above() {
  SceneBuilder builder;
  builder.add(parallelogram({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}), diffuse(0.5f));
  return builder;
}

Image shadow(const SceneBuilder& builder, int spp = 16) {
  RenderSettings settings;
  settings.camera.yfov = 0.1f;
  settings.camera.to_world.origin = Vec3f(0, 0, 1);
  settings.width = settings.height = size;
  settings.limits.spp = spp;
  settings.adaptive = false;
  RenderSession session(std::make_shared<const Scene>(builder.description(), SceneOptions()), settings);
  session.run();
  return *session.picture("shadow").layer("shadow");
}

double mean(const Image& image) {
  double sum = 0;
  for (const float value : image.values) sum += value;
  return sum / double(image.values.size());
}

TEST(ShadowLayer, IsOneInTheOpenAndZeroInTheDark) {
  SceneBuilder open = floor_seen_from_above().add(sun(2, {1, 0, 1}));
  const std::vector<float> ones(size_t(3) * size * size, 1), zeros(ones.size(), 0);
  EXPECT_EQ(shadow(open).values, ones);
  open.add(parallelogram({1, -5, 0}, {0, 10, 0}, {0, 0, 10}), diffuse(0.5f));
  EXPECT_EQ(shadow(open).values, zeros);
}

TEST(ShadowLayer, IsOneWhereThereIsNoLight) {
  EXPECT_EQ(shadow(floor_seen_from_above()).values, std::vector<float>(size_t(3) * size * size, 1));
}

TEST(ShadowLayer, OfOneOfTwoSunsIsThePartOfTheOther) {
  SceneBuilder builder = floor_seen_from_above().add(sun(1, {1, 0, 1})).add(sun(3, {-1, 0, 2}));
  builder.add(parallelogram({1, -5, 0}, {0, 10, 0}, {0, 0, 10}), diffuse(0));
  const double hidden = 1 / std::sqrt(2), seen = 3 * 2 / std::sqrt(5);
  EXPECT_NEAR(mean(shadow(builder)), seen / (seen + hidden), 0.01);
}

TEST(ShadowLayer, OfHalfTheSkyIsItsHalf) {
  // A wall behind which half of the hemisphere lies, of the same irradiance as the other half.
  SceneBuilder builder = floor_seen_from_above().environment([](const Vec3f&) { return 1.f; });
  builder.add(parallelogram({0.2f, -1000, 0}, {0, 2000, 0}, {0, 0, 2000}), diffuse(0));
  EXPECT_NEAR(mean(shadow(builder)), 0.5, 0.01);
}

}  // namespace
}  // namespace vernier::test
