// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "tests/support/effort.h"
#include "tests/support/test_scenes.h"

// Ground of which the camera sees the shadow alone: what is behind the scene, times the part of the light
// from above that gets there.

namespace vernier::test {
namespace {

MaterialDescription shadow_ground() {
  MaterialDescription m = diffuse(0.5f);
  m.catches_shadow = true;
  return m;
}

MeshDescription ground() { return parallelogram({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}); }

constexpr float side = 1, height = 0.8f;

/// A black square above the origin, faces to both sides.
SceneBuilder& add_square(SceneBuilder& builder) {
  MaterialDescription black = diffuse(0);
  black.double_sided = true;
  return builder.add(parallelogram({-side / 2, height, side / 2}, {side, 0, 0}, {0, 0, -side}), black);
}

/// Form factor of that square from level ground under its middle (Howell, "A Catalog of Radiation Heat
/// Transfer Configuration Factors", B-3, four times).
double form_factor() {
  const double a = side / 2 / height, root = std::sqrt(1 + a * a);
  return 4 / (2 * pi) * 2 * (a / root) * std::atan(a / root);
}

struct Seen {
  Samples background;  ///< of sets
  int surfaces = 0;    ///< samples that meet one
};

/// Along a camera ray to a point of the ground that nothing hides from it.
Seen look(const Scene& scene, const Vec3f& at, bool background_apart = true) {
  const auto integrator = path({.max_depth = 4, .background_apart = background_apart});
  Seen seen;
  const int samples = 4096 / thinning;
  for (uint32_t set = 0; set < 8; ++set) {
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
      Sampler sampler(set, uint32_t(i), 5);
      const Estimate estimate =
          integrator->estimate(scene, ray_through(at + Vec3f(0, 0.2f, 4), at), sampler, {});
      EXPECT_TRUE(!background_apart || is_black(estimate.radiance));
      sum += double(estimate.background.y) / samples;
      seen.surfaces += estimate.met_surface;
    }
    seen.background.add(sum);
  }
  return seen;
}

const auto white_sky = [](const Vec3f&) { return 1.f; };

TEST(GroundShadow, IsThePartOfTheSkyThatIsHidden) {
  SceneBuilder builder;
  builder.add(ground(), shadow_ground()).environment(white_sky);
  const Seen seen = look(add_square(builder).build(), {0, 0, 0});
  EXPECT_GT(mean_p_value(seen.background, 1 - form_factor()), 1e-4) << seen.background.mean();
  EXPECT_LT(seen.background.standard_error(), 0.01 * coarsening);
}

TEST(GroundShadow, IsNothingWhereNothingIsHidden) {
  PunctualLightDescription lamp;
  lamp.intensity = 3;
  lamp.to_world.origin = {2, 3, 1};
  SceneBuilder builder;
  builder.add(ground(), shadow_ground()).add(lamp).environment([](const Vec3f& w) { return 1 + w.x; });
  const Seen seen = look(builder.build(), {0, 0, 0});
  EXPECT_EQ(seen.background.mean(), 1);
  EXPECT_EQ(seen.background.variance(), 0) << "every sample says so";
  EXPECT_EQ(seen.surfaces, 0) << "the error of a picture does not count such pixels";
}

TEST(GroundShadow, WeighsLampsAndSkyByTheirIrradiance) {
  PunctualLightDescription lamp;
  lamp.intensity = 8;
  lamp.to_world.origin = {0, 2, 0};  // irradiance 2 at the origin, hidden by the square
  SceneBuilder builder;
  builder.add(ground(), shadow_ground()).add(lamp).environment(white_sky);
  const Seen seen = look(add_square(builder).build(), {0, 0, 0});
  const double sky = pi, lit = sky * (1 - form_factor());
  EXPECT_GT(mean_p_value(seen.background, lit / (sky + 2)), 1e-4) << seen.background.mean();
  const Scene dark = add_square(SceneBuilder().add(ground(), shadow_ground()).add(lamp)).build();
  EXPECT_EQ(look(dark, {0, 0, 0}).background.mean(), 0);
  EXPECT_EQ(look(dark, {9, 0, 0}).background.mean(), 1);
}

TEST(GroundShadow, IsTintedByWhatLetsLightThrough) {
  MaterialDescription pane = glass(0);
  pane.thickness = 0;
  pane.base_color = {0.5f, 0.5f, 0.5f, 1};
  pane.double_sided = true;
  PunctualLightDescription sun;
  sun.kind = PunctualLightDescription::Kind::directional;
  sun.to_world = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, 0, 0}};  // shines down
  const Scene scene = SceneBuilder()
                          .add(ground(), shadow_ground())
                          .add(sun)
                          .add(parallelogram({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}), pane)
                          .build();
  EXPECT_NEAR(look(scene, {0.2f, 0, 0.1f}).background.mean(), 0.5 * 0.96, 1e-3)
      << "Fresnel at either side, once";
}

// Where the surroundings are seen, and to light that does not go straight to the camera, it is a matt
// surface.
TEST(GroundShadow, IsAMattSurfaceElse) {
  const Scene scene = SceneBuilder().add(ground(), shadow_ground()).environment(white_sky).build();
  const Seen seen = look(scene, {0, 0, 0}, false);
  EXPECT_EQ(seen.background.mean(), 0);
  EXPECT_GT(seen.surfaces, 0);
  const Scene mirrored = SceneBuilder()
                             .add(ground(), shadow_ground())
                             .add(parallelogram({-1, 0.1f, -1}, {2, 0, 0}, {0, 2, 0}), metal(0))
                             .environment([](const Vec3f& w) { return w.y > 0 ? 1.f : 0.f; })
                             .build();
  EXPECT_TRUE(
      sees(mirrored, *path({.background_apart = true}), ray_through({0, 2, 1}, {0, 1, -1}), 0.5, 0.05));
}

}  // namespace
}  // namespace vernier::test
