// SPDX-License-Identifier: Apache-2.0
#include "tests/support/effort.h"
#include "tests/support/test_scenes.h"

// BSDF sampling, light sampling and both combined estimate the same light, with and without Russian roulette.

namespace vernier::test {
namespace {

struct View {
  const char* name;
  Scene scene;
  Ray ray;
  int max_depth;
  double resolution;       ///< relative bias that is to be found nine times in ten
  bool has_lamps = false;  ///< which BSDF sampling alone never finds
};

MaterialDescription grey(MaterialDescription material, float reflectance) {
  material.base_color = {reflectance, reflectance, reflectance, 1};
  return material;
}

/// Direct light of a near lamp and a sky on glossy plastic: both techniques matter.
View glossy() {
  return {"glossy",
          SceneBuilder()
              .add(parallelogram({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), grey(plastic(0.4f), 0.5f))
              .add(parallelogram({-1, 0.5f, -2}, {2, 0, 0}, {0, 1.5f, 0.5f}), emitter(2))
              .environment([](const Vec3f& w) { return 0.3f + 2 * std::max(0.f, w.x * w.x * w.x); })
              .build(),
          ray_through({0.3f, 1, 2}, {0.2f, 0, 0}), 2, 2e-3};
}

/// A room with a large lamp and a rough metal block.
View room() {
  return {"room",
          SceneBuilder()
              .add(box({-1, 0, -1}, {1, 2, 1}, true), grey(plastic(0.6f), 0.6f))
              .add(parallelogram({-0.6f, 1.8f, -0.6f}, {1.2f, 0, 0}, {0, 0, 1.2f}), emitter(3))
              .add(box({-0.7f, 0.01f, -0.7f}, {-0.1f, 0.8f, -0.2f}), grey(metal(0.5f), 0.7f))
              .build(),
          ray_through({0.5f, 1, 0.9f}, {-0.4f, 0.5f, -0.2f}), 4, 2e-2};
}

/// Many lamps, chosen by the light tree.
View lamps() {
  SceneBuilder builder;
  builder.add(parallelogram({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), grey(plastic(0.5f), 0.8f));
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      const Vec3f at(float(i) - 2.5f, 0.5f + 0.2f * float((i * 3 + j * 2) % 4), float(j) - 2.5f);
      builder.add(parallelogram(at, {0.8f, 0.1f * float(i - 2), 0}, {0, 0.1f * float(j - 2), 0.8f}),
                  emitter(float(2 + (i + j) % 3)));
    }
  return {"lamps", builder.build(), ray_through({0.55f, 3, 0.45f}, {0.5f, 0, 0.4f}), 3, 1e-2};
}

/// A metal block under a sky with a bright side, and light that it sends to the floor.
View sky() {
  return {"sky",
          SceneBuilder()
              .add(parallelogram({-9, 0, -9}, {0, 0, 18}, {18, 0, 0}), grey(diffuse(1), 0.5f))
              .add(box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}), grey(metal(0.6f), 0.9f))
              .environment([](const Vec3f& w) { return 0.2f + 3 * std::max(0.f, w.x * w.x * w.x); })
              .build(),
          ray_through({2, 1.4f, 2}, {0.9f, 0, 0.1f}), 4, 1e-2};
}

/// A lamp within a block of coloured wax: light that is sampled through a surface is absorbed on its far
/// side.
View wax() {
  MaterialDescription material = grey(plastic(0.5f), 0.8f);
  material.diffuse_transmission = 0.8f;
  material.thickness = 1;
  material.attenuation_color = {0.4f, 0.5f, 1};
  material.attenuation_distance = 0.3f;
  return {"wax",
          SceneBuilder()
              .add(box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}), material)
              .add(parallelogram({-0.2f, 0.3f, -0.2f}, {0.4f, 0, 0}, {0, 0.4f, 0}), emitter(4))
              .environment([](const Vec3f& w) { return 0.2f + std::max(0.f, w.x * w.x * w.x); })
              .build(),
          ray_through({0.6f, 1.4f, 2}, {0.1f, 0.5f, 0.5f}), 4, 1e-2};
}

/// Brushed metal under a coat that shines by itself, and velvet.
View layers() {
  MaterialDescription floor = grey(metal(0.4f), 0.8f);
  floor.anisotropy = 0.6f;
  floor.clearcoat = 0.8f;
  floor.clearcoat_roughness = 0.4f;
  MaterialDescription velvet = grey(plastic(0.7f), 0.3f);
  velvet.sheen_color = {0.9f, 0.9f, 0.9f};
  velvet.sheen_roughness = 0.4f;
  MaterialDescription lamp = emitter(3);
  lamp.clearcoat = 1;
  return {"layers",
          SceneBuilder()
              .add(parallelogram({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), floor)
              .add(box({-0.9f, 0.01f, -0.6f}, {-0.2f, 0.8f, 0.1f}), velvet)
              .add(parallelogram({-1, 0.5f, -2}, {2, 0, 0}, {0, 1.5f, 0.5f}), lamp)
              .build(),
          ray_through({0.3f, 1, 2}, {0.1f, 0, 0}), 4, 1e-2};
}

View flame_card(AlphaMode mode) {
  SceneBuilder builder;
  builder.add(parallelogram({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), grey(plastic(0.5f), 0.6f));
  add_flame_cards(builder, mode);
  return {mode == AlphaMode::mask ? "flame_card, MASK" : "flame_card, BLEND", builder.build(),
          ray_through({0.3f, 1, 2}, {0.2f, 0, 0}), 3, 1e-2};
}

MaterialDescription water(float ior, float left) {
  MaterialDescription material = grey(glass(0), 1);
  material.ior = ior;
  material.attenuation_color = Rgb(left);
  material.attenuation_distance = 1;
  return material;
}

/// A sheet of rough tinted water over a floor: it encloses nothing.
View lake() {
  MaterialDescription sheet = water(1.33f, 0.4f);
  sheet.roughness = 0.5f;
  return {"lake",
          SceneBuilder()
              .add(parallelogram({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), sheet)
              .add(parallelogram({-5, -1, -5}, {0, 0, 10}, {10, 0, 0}), grey(diffuse(1), 0.5f))
              .environment([](const Vec3f& w) { return 1 + 2 * std::max(0.f, w.x); })
              .build(),
          ray_through({0.3f, 1, 2}, {0.2f, 0, 0}), 6, 1e-2};
}

/// A leaf that lets light through, in water that absorbs.
View terrarium() {
  MaterialDescription leaf = grey(diffuse(1), 0.8f);
  leaf.diffuse_transmission = 0.6f;
  MaterialDescription surface = water(1, 0.3f);
  return {"terrarium",
          SceneBuilder()
              .add(box({-2, -1, -2}, {2, 1, 2}), surface)
              .add(parallelogram({-1, 0.3f, -1}, {0, 0.3f, 2}, {2, 0, 0}), leaf)
              .add(parallelogram({-1.9f, -0.9f, -1.9f}, {0, 0, 3.8f}, {3.8f, 0, 0}), grey(diffuse(1), 0.7f))
              .add(parallelogram({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), emitter(5))
              .environment([](const Vec3f& w) { return 0.3f + std::max(0.f, w.y); })
              .build(),
          ray_through({0.3f, 3, 4}, {0.1f, 0.4f, 0}), 6, 1e-2};
}

/// Light within and outside of clear bodies in bodies, some of which bend nothing.
View nested_glass() {
  return {"nested_glass",
          SceneBuilder()
              .add(parallelogram({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}), grey(diffuse(1), 0.7f))
              .add(box({-1, 0, -1}, {1, 2, 1}), water(1.2f, 0.5f))
              .add(box({-0.7f, 0.4f, -0.7f}, {0.7f, 1.6f, 0.7f}), water(1, 1))
              .add(box({-0.3f, 0.7f, -0.3f}, {0.3f, 1.2f, 1.4f}), water(1.2f, 0.6f))
              .add(box({1.5f, 0, -1}, {2.5f, 1, 1}), water(1, 0.4f))
              .add(parallelogram({1.7f, 0.5f, -0.5f}, {0.6f, 0, 0}, {0, 0, 1}), emitter(5))
              .environment([](const Vec3f& w) { return 0.3f + std::max(0.f, w.x * w.x * w.x); })
              .build(),
          ray_through({0.3f, 3, 4}, {1.3f, 0, 0.6f}), 6, 1e-2};
}

/// A floor beneath liquid that overlaps the wall of its glass.
View liquid_in_glass() {
  return {"liquid_in_glass",
          SceneBuilder()
              .add(box({-1, 0, -1}, {1, 2, 1}), water(1.3f, 0.9f))
              .add(box({-0.85f, 0.2f, -0.85f}, {0.85f, 2, 0.85f}), water(1, 1))
              .add(box({-0.9f, 0.1f, -0.9f}, {0.9f, 1.2f, 0.9f}), water(1.3f, 0.5f))
              .add(parallelogram({-0.7f, 0.4f, -0.7f}, {0, 0, 1.4f}, {1.4f, 0, 0}), grey(plastic(0.6f), 0.6f))
              .add(parallelogram({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}), emitter(4))
              .environment([](const Vec3f&) { return 0.3f; }, 2)
              .build(),
          ray_through({0.2f, 4, 2}, {0.1f, 0.4f, 0}), 8, 1e-2};
}

View camera_under_water() {
  return {"camera_under_water",
          SceneBuilder()
              .add(box({-3, 0, -3}, {3, 3, 3}), water(1.33f, 0.6f))
              .add(parallelogram({-2.9f, 0.1f, -2.9f}, {0, 0, 5.8f}, {5.8f, 0, 0}), grey(diffuse(1), 0.8f))
              .add(parallelogram({-1, 1, -1}, {0.5f, 0, 0}, {0, 0, 0.5f}), emitter(6))
              .environment([](const Vec3f& w) { return 1 + std::max(0.f, w.y); })
              .build(),
          ray_through({0.2f, 2, 2}, {0.1f, 0.1f, 0}), 6, 1e-2};
}

PunctualLightDescription lamp(PunctualLightDescription::Kind kind, const Vec3f& at, const Vec3f& shines,
                              float intensity) {
  PunctualLightDescription light;
  light.kind = kind;
  light.intensity = intensity;
  light.outer_cone = 0.5f;
  light.to_world.origin = at;
  light.to_world.z = -normalize(shines);
  return light;
}

using Kind = PunctualLightDescription::Kind;

/// Pairs of spots that shine up and down.
View sconces() {
  SceneBuilder builder;
  builder.add(box({-4, 0, -4}, {4, 3, 4}, true), grey(diffuse(1), 0.5f));
  for (int i = 0; i < 9; ++i) {
    const int column = i % 3, row = i / 3;
    const Vec3f at(float(column) * 2 - 2, 1.5f, float(row) * 2 - 2);
    builder.add(lamp(Kind::spot, at, {0, 1, 0}, 3)).add(lamp(Kind::spot, at, {0.01f, -1, 0}, 3));
  }
  return {"sconces", builder.build(), ray_through({0.5f, 1, 3}, {0.2f, 0, 0.1f}), 3, 1e-2, true};
}

/// Lamps of 10 candela on ground that the sun lights too, and shade.
View sun_and_lamps() {
  SceneBuilder builder;
  builder.add(parallelogram({-200, 0, -200}, {0, 0, 400}, {400, 0, 0}), grey(diffuse(1), 0.5f))
      .add(parallelogram({-3, 2.5f, -3}, {6, 0, 0}, {0, 0, 6}), grey(diffuse(1), 0.1f))
      .add(lamp(Kind::directional, {0, 0, 0}, {0.01f, -1, 0}, 1e5f));
  for (int i = 0; i < 6; ++i) builder.add(lamp(Kind::point, {float(i) - 2.5f, 2, 0.3f}, {0, -1, 0}, 10));
  return {"sun_and_lamps", builder.build(), ray_through({0.5f, 1, 2}, {0.2f, 0, 0.1f}), 2, 1e-2, true};
}

/// Sun, sky and a lamp through panes, one of them tinted.
View window_sun() {
  MaterialDescription pane = grey(glass(0), 1);
  pane.thickness = 0;
  MaterialDescription tinted = pane;
  tinted.base_color = {0.5f, 0.7f, 0.9f, 1};
  tinted.roughness = 0.03f;
  return {"window_sun",
          SceneBuilder()
              .add(parallelogram({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), grey(plastic(0.5f), 0.6f))
              .add(parallelogram({-4, 1, -4}, {8, 0, 0}, {0, 0.1f, 8}), pane)
              .add(parallelogram({-4, 1.3f, -4}, {8, 0.3f, 0}, {0, 0, 8}), tinted)
              .add(parallelogram({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), emitter(3))
              .add(lamp(Kind::directional, {0, 0, 0}, {0.5f, -1, 0.2f}, 2))
              .environment([](const Vec3f& w) { return 0.3f + std::max(0.f, w.y); })
              .build(),
          ray_through({0.3f, 0.8f, 2}, {0.2f, 0, 0}),
          6,
          1e-2,
          true};
}

View flame_card_mask() { return flame_card(AlphaMode::mask); }
View flame_card_blend() { return flame_card(AlphaMode::blend); }

struct Technique {
  const char* name;
  LightSampling sampling;
  bool roulette;
  float spread = 0;  ///< of the pixel
};
constexpr Technique techniques[] = {{"mis", LightSampling::mis, true},
                                    {"mis without roulette", LightSampling::mis, false},
                                    {"light", LightSampling::light, true},
                                    {"bsdf", LightSampling::bsdf, true},
                                    {"mis in a noisy pixel", LightSampling::mis, true, 10}};

// Welch's test on means of 32 independent stratified sets, family significance 0.001, with as many samples as
// a bias of the view's resolution takes to be found nine times in ten.
TEST(Techniques, Agree) {
  for (const auto make_view :
       {glossy, room, lamps, sky, wax, layers, flame_card_mask, flame_card_blend, lake, terrarium,
        nested_glass, liquid_in_glass, camera_under_water, sconces, sun_and_lamps, window_sun}) {
    const View view = make_view();
    const auto run = [&](const Technique& technique, uint64_t seed, int samples) {
      IntegratorOptions options;
      options.max_depth = view.max_depth;
      options.light_sampling = technique.sampling;
      options.russian_roulette = technique.roulette;
      return measure(view.scene, *path(options), view.ray, samples, 32, seed, technique.spread);
    };
    const double significance = sidak(1e-3, 64);
    const auto resolved = [&](const Technique& technique, uint64_t seed, uint64_t factor) {
      for (int samples = 1 << 8, more = 2; samples <= 1 << 17; samples *= more) {
        const Samples measured = run(technique, seed, samples);
        // Two such errors add to that of a difference.
        const double error = std::numbers::sqrt2 * measured.standard_error();
        const double excess =
            detectable_bias(error, significance) / (coarsening * view.resolution * measured.mean());
        if (excess <= 1) return factor == 1 ? measured : run(technique, seed, samples * int(factor));
        more = excess > 4 ? 8 : excess > 2 ? 4 : 2;
      }
      ADD_FAILURE() << view.name << ": " << technique.name << " is too noisy to compare";
      return run(technique, seed, 1);
    };
    Baseline<Samples> by_first(
        [&](uint64_t seed, uint64_t factor) { return resolved(techniques[0], seed, factor); });
    for (const Technique& technique : std::span(techniques).subspan(1)) {
      if (view.has_lamps && technique.sampling == LightSampling::bsdf) continue;
      EXPECT_TRUE(confirmed(significance, 1,
                            [&](uint64_t seed, uint64_t factor) {
                              return welch_p_value(by_first(seed, factor),
                                                   resolved(technique, seed + 100, factor));
                            }))
          << view.name << ": " << techniques[0].name << " against " << technique.name;
    }
  }
}

}  // namespace
}  // namespace vernier::test
