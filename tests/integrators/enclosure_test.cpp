// SPDX-License-Identifier: Apache-2.0
#include "tests/support/test_scenes.h"

// Closed rooms, where the radiance is known in every order of reflection.

namespace vernier::test {
namespace {

Scene room(float reflectance, float radiance, const std::string& accelerator = {}) {
  MaterialDescription walls = diffuse(reflectance);
  walls.emissive = Rgb(radiance);
  return SceneBuilder().add(box({-1, -2, -1.5f}, {2, 1, 3}, true), walls).build(accelerator);
}

const Ray inside = ray_through({0.3f, -0.4f, 0.2f}, {1.9f, 0.5f, 2});

// Emission Le and reflectance rho everywhere: Le (1 - rho^k) / (1 - rho) with k path vertices.
TEST(Enclosure, RadianceOfEveryDepth) {
  const float rho = 0.6f, emitted = 0.5f;
  const Scene scene = room(rho, emitted);
  for (const LightSampling technique : {LightSampling::mis, LightSampling::light, LightSampling::bsdf})
    for (const int depth : {1, 2, 3, 6}) {
      IntegratorOptions options;
      options.max_depth = depth;
      options.light_sampling = technique;
      const double expected = emitted * (1 - std::pow(rho, depth)) / (1 - rho);
      // Light sampling alone has infinite variance where walls meet: it is tested here for being near,
      // elsewhere for being exact.
      const double resolution = technique == LightSampling::light ? 0.05 : 5e-3;
      EXPECT_TRUE(sees(scene, *path(options), inside, expected, resolution))
          << "depth " << depth << ", technique " << int(technique);
    }
}

// BSDF sampling alone meets the same emission at each bounce, so nothing varies but the roulette.
TEST(Enclosure, ConvergesToTheGeometricSeries) {
  for (const auto& [rho, resolution] : {std::pair(0.5f, 1e-3), std::pair(0.8f, 3e-3)}) {
    IntegratorOptions options;
    options.max_depth = 1000;
    options.light_sampling = LightSampling::bsdf;
    EXPECT_TRUE(sees(room(rho, 1), *path(options), inside, 1 / (1 - rho), resolution)) << rho;
    options.russian_roulette = false;
    options.max_depth = 100;
    EXPECT_NEAR(measure(room(rho, 1), *path(options), inside, 8).mean(), 1 / (1 - rho), 1e-5 / (1 - rho))
        << rho;
  }
}

TEST(Enclosure, EveryAcceleratorKeepsItClosed) {
  for (const auto& entry : accelerators()) {
    const Scene scene = room(0.5f, 1, std::string(entry.name));
    IntegratorOptions options;
    options.max_depth = 40;
    options.light_sampling = LightSampling::bsdf;
    options.russian_roulette = false;
    const Samples measured = measure(scene, *path(options), inside, 256);
    EXPECT_NEAR(measured.mean(), 2, 1e-5) << entry.name;
  }
}

// A point light of intensity I in the middle of a closed sphere: rho I / (pi R^2 (1 - rho)) everywhere.
TEST(Enclosure, PointLightInASphere) {
  MeshDescription ball = sphere({0, 0, 0}, 1, 64, 128);
  for (Triangle& t : ball.triangles) std::swap(t[1], t[2]);
  PunctualLightDescription light;
  light.intensity = pi;
  const Scene scene = SceneBuilder().add(ball, diffuse(0.5f)).add(light).build();
  IntegratorOptions options;
  options.max_depth = 60;
  // Facets lie within the sphere: their distance is on average 0.9992.
  EXPECT_TRUE(sees(scene, *path(options), ray_through({0, 0, 0.2f}, {0.6f, 0.3f, 0.5f}), 1, 3e-3));
}

}  // namespace
}  // namespace vernier::test
