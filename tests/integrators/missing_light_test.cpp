// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/missing_light.h"

#include "integrators/render/render.h"
#include "scene/camera.h"
#include "tests/support/test_scenes.h"

// What a picture leaves out is counted, in figures that are right where there is a closed form.

namespace vernier::test {
namespace {

SceneBuilder floor_scene() {
  return SceneBuilder().add(parallelogram({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}), diffuse(0.5f));
}

/// Looks straight down.
MissingEstimate missing(const Scene& scene, int max_depth, bool adaptive = true,
                        std::string_view integrator = "path") {
  CameraDescription camera;
  camera.to_world.x = {1, 0, 0};
  camera.to_world.y = {0, 0, -1};
  camera.to_world.z = {0, 1, 0};
  camera.to_world.origin = {0, 12, 0};
  camera.yfov = 0.2f;
  IntegratorOptions options;
  options.max_depth = max_depth;
  options.caustics = Caustics::off;
  RenderSettings render_options;
  render_options.width = render_options.height = 24;
  render_options.limits.spp = 64;
  render_options.adaptive = adaptive;
  render_options.integrator_options = options;
  const std::atomic<bool> stop = false;
  return render(scene, Camera(camera, 24, 24), *make_integrator(std::string(integrator), options),
                render_options, stop)
      .missing;
}

TEST(MissingLight, NoneWhereNothingIsLeftOut) {
  const Scene scene = floor_scene().add(point_lamp({0, 2, 0}, 10)).build();
  const MissingEstimate none = missing(scene, 16);
  EXPECT_EQ(none.bent.share, 0);
  EXPECT_EQ(none.bent.rel_rmse, 0);
  EXPECT_LT(none.depth.share, 1e-3);
}

// All light comes through a bulb: none is found, and all of it is told.
TEST(MissingLight, LampInABulb) {
  MaterialDescription bulb = glass(0);
  bulb.ior = 1.5f;
  for (const char* integrator : {"path", "whitted"}) {
    MaterialDescription black = diffuse(0.5f);
    const Scene scene = floor_scene()
                            .add(sphere({0, 2, 0}, 0.5f, 16, 32), bulb)
                            .add(sphere({0, 2, 0}, 0.45f, 16, 32),
                                 [] {
                                   MaterialDescription air = glass(0);
                                   air.ior = 1;
                                   return air;
                                 }())
                            .add(point_lamp({0, 2, 0}, 40))
                            .build();
    const MissingEstimate told = missing(scene, 16, true, integrator);
    EXPECT_GT(told.bent.share, integrator == std::string("path") ? 0.9 : 0.1) << integrator;
    EXPECT_GT(told.bent.rel_rmse, 0.5) << integrator;
  }
}

// Between two parallel white walls under a white sky... a furnace: of an infinite series of bounces with
// albedo a, those beyond depth n carry a^n of the light.
TEST(MissingLight, DepthLimitInAFurnace) {
  MaterialDescription wall = diffuse(0.8f);
  wall.emissive = Rgb(1);
  const Scene scene = SceneBuilder().add(box({-3, -3, -3}, {3, 15, 3}, true), wall).build();
  for (const int depth : {1, 4, 12})
    for (const bool adaptive : {false, true})
      for (const char* integrator : {"path", "light"})
        EXPECT_NEAR(missing(scene, depth, adaptive, integrator).depth.share, std::pow(0.8, depth), 0.03)
            << depth << " " << integrator;
}

}  // namespace
}  // namespace vernier::test
