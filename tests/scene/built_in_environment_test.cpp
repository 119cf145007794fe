// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/built_in_environment.h"

#include <gtest/gtest.h>

#include "core/base/names.h"
#include "scene/lights/environment.h"

namespace vernier::test {
namespace {

EnvironmentLight light_of(const std::string& name, float rotation = 0) {
  auto environment = std::make_shared<EnvironmentDescription>();
  environment->picture = find_by_name(built_in_environments(), "environment", name).picture();
  environment->rotation = rotation;
  return EnvironmentLight(environment);
}

/// Radiance of a white diffuse surface with that normal: the mean of radiance weighted by the cosine.
double white_surface(const EnvironmentLight& light, const Vec3f& normal) {
  constexpr int rows = 512;
  double sum = 0, weights = 0;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < 2 * rows; ++j) {
      const float theta = pi * (float(i) + 0.5f) / rows, phi = pi * (float(j) + 0.5f) / rows;
      const Vec3f w(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      const double weight = std::max(0.f, dot(w, normal)) * std::sin(theta);
      sum += weight * double(luminance(light.radiance(w)));
      weights += weight;
    }
  return sum / weights;
}

TEST(BuiltInEnvironment, StudioShowsWhiteNearlyWhiteOnTopAndModelsTheSides) {
  const EnvironmentLight studio = light_of("studio");
  EXPECT_NEAR(white_surface(studio, {0, 1, 0}), 0.9, 0.1);
  const double left = white_surface(studio, {-1, 0, 0}), right = white_surface(studio, {1, 0, 0});
  EXPECT_GT(left, 1.3 * right);  // the key
  EXPECT_LT(white_surface(studio, {0, -1, 0}), 0.5 * white_surface(studio, {0, 1, 0}));
  for (const Vec3f& normal :
       {Vec3f(0, 0, 1), Vec3f(1, 0, 0), Vec3f(-1, 0, 0), Vec3f(0, 0, -1), Vec3f(0, -1, 0)})
    EXPECT_GT(white_surface(studio, normal), 0.2) << normal;
}

TEST(BuiltInEnvironment, BehindTheSubjectIsAQuietGradient) {
  const EnvironmentLight studio = light_of("studio");
  for (float azimuth = -0.55f; azimuth <= 0.55f; azimuth += 0.05f)
    for (float elevation = -0.7f; elevation <= 0.2f; elevation += 0.02f) {
      const Vec3f w(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                    -std::cos(azimuth) * std::cos(elevation));
      const float value = luminance(studio.radiance(w));
      EXPECT_GT(value, 0.1f);
      EXPECT_LT(value, 0.4f);
    }
}

TEST(BuiltInEnvironment, TheStudioFollowsTheCamera) {
  const EnvironmentLight studio = light_of("studio");
  const Vec3f ahead(0, -0.17f, -0.985f), beside(0.8f, 0.5f, -0.33f);
  for (const Vec3f& looks : {Vec3f(0, 0, -1), Vec3f(1, 0, 0), Vec3f(-0.6f, 0, 0.8f), Vec3f(0, 0, 1)}) {
    CameraDescription camera;
    camera.to_world.z = -looks;
    camera.to_world.x = cross(Vec3f(0, 1, 0), -looks);
    const EnvironmentLight turned = light_of("studio", heading(camera));
    for (const Vec3f& seen : {ahead, beside}) {
      const Vec3f w = camera.to_world.vector(seen);
      EXPECT_NEAR(luminance(turned.radiance(w)), luminance(studio.radiance(normalize(seen))), 0.02f) << looks;
    }
  }
}

TEST(BuiltInEnvironment, LookingStraightDownTheTopOfThePictureIsAhead) {
  CameraDescription camera;
  camera.to_world = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 5, 0}};  // looks down, its picture's top toward +x
  EXPECT_NEAR(heading(camera), -pi / 2, 1e-5);
  camera.to_world = {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 5, 0}};  // looks up, its bottom toward +x
  EXPECT_NEAR(heading(camera), -pi / 2, 1e-5);
}

TEST(BuiltInEnvironment, SkyIsBrightestOverhead) {
  const EnvironmentLight sky = light_of("sky");
  EXPECT_NEAR(luminance(sky.radiance({0, 1, 0})), 1, 0.01);
  EXPECT_NEAR(luminance(sky.radiance({0, -1, 0})), 0.3, 1e-5);
}

}  // namespace
}  // namespace vernier::test
