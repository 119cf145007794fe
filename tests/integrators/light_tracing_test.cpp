// SPDX-License-Identifier: Apache-2.0
#include "tests/support/effort.h"
#include "tests/support/pictures.h"

// Paths from the lights find the same light as paths from the camera, wherever both can find it.

namespace vernier::test {
namespace {

struct View {
  const char* name;
  SceneBuilder scene;
  CameraDescription camera = camera_at({0.5f, 1.5f, 3}, {0, 0.3f, 0}, 0.6f);
  int max_depth = 4;
  double resolution = 0.03;  ///< relative bias of the picture that is to be found nine times in ten
  PixelFilter filter = {};
  Fog fog = {};
};

MaterialDescription grey(MaterialDescription material, float reflectance) {
  material.base_color = {reflectance, 0.8f * reflectance, 0.6f * reflectance, 1};
  return material;
}

MeshDescription floor_mesh() { return parallelogram({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}); }

using Kind = PunctualLightDescription::Kind;

PunctualLightDescription lamp(Kind kind, const Vec3f& at, const Vec3f& shines, float intensity) {
  PunctualLightDescription light;
  light.kind = kind;
  light.color = {1, 0.9f, 0.7f};
  light.intensity = intensity;
  light.inner_cone = 0.3f;
  light.outer_cone = 0.7f;
  light.to_world.origin = at;
  light.to_world.z = -normalize(shines);
  return light;
}

View room() {
  return {"room",
          SceneBuilder()
              .add(box({-1, 0, -1}, {1, 2, 1}, true), grey(plastic(0.6f), 0.6f))
              .add(parallelogram({-0.6f, 1.8f, -0.6f}, {1.2f, 0, 0}, {0, 0, 1.2f}), emitter(3))
              .add(box({-0.7f, 0.01f, -0.7f}, {-0.1f, 0.8f, -0.2f}), grey(metal(0.5f), 0.7f)),
          camera_at({0.5f, 1, 0.9f}, {-0.4f, 0.5f, -0.2f}, 1)};
}

/// Lamps of all kinds; one ends at its range.
View lamps() {
  PunctualLightDescription near = lamp(Kind::point, {-1, 1, 0.5f}, {0, -1, 0}, 4);
  near.range = 2;
  return {"lamps", SceneBuilder()
                       .add(floor_mesh(), grey(plastic(0.5f), 0.7f))
                       .add(box({-0.3f, 0, -0.3f}, {0.3f, 0.8f, 0.3f}), grey(diffuse(1), 0.8f))
                       .add(near)
                       .add(lamp(Kind::spot, {1, 2, 1}, {-0.5f, -1, -0.4f}, 6))
                       .add(lamp(Kind::directional, {0, 0, 0}, {0.3f, -1, 0.2f}, 0.5f))};
}

View sky() {
  return {"sky", SceneBuilder()
                     .add(floor_mesh(), grey(diffuse(1), 0.5f))
                     .add(box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}), grey(metal(0.6f), 0.9f))
                     .environment([](const Vec3f& w) { return 0.2f + 3 * std::max(0.f, w.x * w.x * w.x); })};
}

View flame_card(AlphaMode mode) {
  SceneBuilder builder;
  builder.add(floor_mesh(), grey(plastic(0.5f), 0.6f));
  add_flame_cards(builder, mode);
  return {mode == AlphaMode::mask ? "flame card, MASK" : "flame card, BLEND", builder};
}
View flame_card_mask() { return flame_card(AlphaMode::mask); }
View flame_card_blend() { return flame_card(AlphaMode::blend); }

/// Uneven emission by a texture; a lamp under a coat, which dims it toward the horizon.
View screens() {
  MaterialDescription screen = emitter(4);
  screen.emissive_texture.texture = 0;
  MaterialDescription coated = emitter(3);
  coated.clearcoat = 1;
  coated.clearcoat_roughness = 0.5f;
  return {"screens", SceneBuilder()
                         .texture(8, 1, {0, 255, 90, 0, 0, 0, 30, 10})
                         .add(floor_mesh(), grey(plastic(0.5f), 0.6f))
                         .add(parallelogram({-1, 0.1f, -1}, {2, 0, 0}, {0, 1.5f, 0.3f}), screen)
                         .add(parallelogram({-1, 1.8f, -1}, {2, 0, 0}, {0, 0, 1.5f}), coated)};
}

/// What shading normals, which are not the true ones, do to light is not the same both ways.
View smooth_shading() {
  return {"smooth shading", SceneBuilder()
                                .add(floor_mesh(), grey(diffuse(1), 0.7f))
                                .add(smooth_sphere({0, 0.7f, 0}, 0.6f, 4, 6), grey(plastic(0.5f), 0.9f))
                                .add(parallelogram({-1, 2.5f, -1}, {2, 0, 0}, {0, 0, 2}), emitter(3))
                                .add(lamp(Kind::point, {-2, 1.2f, 1}, {0, -1, 0}, 3))};
}

/// Rough glass bends light into itself and out of it again, and coats and fibres ask for one angle alone.
View layers() {
  MaterialDescription coated = grey(metal(0.4f), 0.8f);
  coated.clearcoat = 0.8f;
  coated.clearcoat_roughness = 0.4f;
  MaterialDescription velvet = grey(plastic(0.7f), 0.3f);
  velvet.sheen_color = {0.9f, 0.9f, 0.9f};
  velvet.sheen_roughness = 0.4f;
  return {"layers", SceneBuilder()
                        .add(floor_mesh(), coated)
                        .add(box({-0.9f, 0.01f, -0.6f}, {-0.2f, 0.8f, 0.1f}), velvet)
                        .add(parallelogram({-1, 0.5f, -2}, {2, 0, 0}, {0, 1.5f, 0.5f}), emitter(3))};
}

View frosted_glass() {
  MaterialDescription frosted = grey(glass(0.6f), 0.9f);
  frosted.attenuation_color = {0.4f, 0.6f, 0.9f};
  frosted.attenuation_distance = 0.5f;
  MaterialDescription dispersing = glass(0.5f);
  dispersing.dispersion = 5;
  return {"frosted glass",
          SceneBuilder()
              .add(floor_mesh(), grey(diffuse(1), 0.7f))
              .add(box({-0.6f, 0.1f, -0.4f}, {0.2f, 0.8f, 0.3f}), frosted)
              .add(box({0.4f, 0.1f, -0.4f}, {0.9f, 0.8f, 0.3f}), dispersing)
              .add(parallelogram({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), emitter(4))
              .add(lamp(Kind::point, {-1.5f, 1.2f, 1}, {0, -1, 0}, 3)),
          camera_at({0.5f, 1.5f, 3}, {0, 0.3f, 0}, 0.6f), 6, 0.06};
}

/// Panes that bend nothing, wax, and water of the index of air; back faces that the camera looks through.
View panes() {
  MaterialDescription pane = grey(glass(0), 1);
  pane.thickness = 0;
  pane.specular = 0;  // it mirrors nothing, which no light path would show the camera
  MaterialDescription wax = grey(plastic(0.5f), 0.8f);
  wax.diffuse_transmission = 0.8f;
  wax.thickness = 1;
  wax.attenuation_color = {0.4f, 0.5f, 1};
  wax.attenuation_distance = 0.3f;
  MaterialDescription water = glass(0);
  water.ior = 1;
  water.attenuation_color = {0.9f, 0.6f, 0.4f};
  water.attenuation_distance = 1;
  return {"panes",
          SceneBuilder()
              .add(floor_mesh(), grey(diffuse(1), 0.7f))
              .add(box({-0.6f, 0.1f, -0.4f}, {0, 0.7f, 0.3f}), wax)
              .add(box({0.2f, 0.1f, -0.4f}, {0.8f, 0.7f, 0.3f}), water)
              .add(parallelogram({0.3f, 0.3f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}), emitter(3))
              .add(parallelogram({-2, 0, 1}, {4, 0, 0}, {0, 2, 0}), pane)
              .add(parallelogram({-2, 0, 1.5f}, {0, 2, 0}, {4, 0, 0}), grey(diffuse(1), 0.7f))
              .add(lamp(Kind::point, {-1, 1.5f, 1.2f}, {0, -1, 0}, 3))
              .add(lamp(Kind::directional, {0, 0, 0}, {0.3f, -1, -0.6f}, 1)),
          camera_at({0.2f, 1.2f, 3}, {0, 0.3f, 0}, 0.6f), 7, 0.03};
}

/// The camera, the lamps and what they shine on lie in water.
View aquarium() {
  MaterialDescription water = glass(0.5f);
  water.ior = 1.33f;
  water.attenuation_color = {0.4f, 0.7f, 0.9f};
  water.attenuation_distance = 2;
  return {"aquarium",
          SceneBuilder()
              .add(box({-3, 0, -3}, {3, 3, 3}), water)
              .add(parallelogram({-2.9f, 0.1f, -2.9f}, {0, 0, 5.8f}, {5.8f, 0, 0}), grey(diffuse(1), 0.8f))
              .add(parallelogram({-1, 1, -1}, {0.5f, 0, 0}, {0, 0, 0.5f}), emitter(6))
              .add(lamp(Kind::point, {1, 1, 0}, {0, -1, 0}, 3)),
          camera_at({0.2f, 1.5f, 2}, {0.1f, 0.1f, 0}, 0.8f), 4, 0.03};
}

/// Lamps and a panel in fog that scatters on, around glass that does not bend.
View foggy() {
  View view = lamps();
  view.name = "foggy";
  view.scene.add(parallelogram({-1, 1.8f, -1}, {0.8f, 0, 0}, {0, 0, 0.8f}), emitter(3));
  view.fog = {0.3f, {0.9f, 0.7f, 0.5f}, 0.5f, 4};
  view.resolution = 0.08;
  return view;
}

/// Fog under a sky, which begins where the fog ends.
View misty_sky() {
  View view = sky();
  view.name = "misty sky";
  view.fog = {0.3f, Rgb(0.9f), -0.3f, 2.5f};
  view.resolution = 0.15;
  return view;
}

/// Media that scatter below a diffuse, a rough and a clear boundary, one with a lamp inside.
View milk() {
  const auto filled = [](MaterialDescription material, const Rgb& albedo, float g) {
    material.thickness = 1;
    material.attenuation_color = {0.1f, 0.2f, 0.4f};
    material.attenuation_distance = 0.3f;
    material.scattering_albedo = albedo;
    material.scattering_anisotropy = g;
    return material;
  };
  MaterialDescription wax = grey(plastic(0.5f), 0.8f);
  wax.diffuse_transmission = 1;
  MaterialDescription clear = glass(0);
  clear.ior = 1;
  return {"milk",
          SceneBuilder()
              .add(floor_mesh(), grey(diffuse(1), 0.7f))
              .add(box({-0.9f, 0.1f, -0.4f}, {-0.4f, 0.7f, 0.3f}), filled(wax, {0.95f, 0.8f, 0.6f}, 0.3f))
              .add(box({-0.3f, 0.1f, -0.4f}, {0.2f, 0.7f, 0.3f}), filled(glass(0.6f), Rgb(0.9f), 0))
              .add(box({0.3f, 0.1f, -0.4f}, {0.9f, 0.7f, 0.3f}), filled(clear, {0.5f, 0.9f, 0.99f}, -0.5f))
              .add(parallelogram({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), emitter(4))
              .add(lamp(Kind::point, {-1.5f, 1.2f, 1}, {0, -1, 0}, 3))
              .add(lamp(Kind::point, {0.6f, 0.4f, 0}, {0, -1, 0}, 0.3f)),
          camera_at({0.5f, 1.5f, 3}, {0, 0.3f, 0}, 0.6f), 6, 0.06};
}

/// Everything moves while the shutter is open.
View moving() {
  const auto moved = [](const Transform& still, float part) {
    Transform to = still;
    to.origin += Vec3f(0.4f * part, 0.1f * part, -0.2f * part);
    return to;
  };
  View view = lamps();
  view.name = "moving";
  PunctualLightDescription swinging = lamp(Kind::spot, {-0.5f, 1.5f, 0.5f}, {0.3f, -1, 0}, 5);
  MeshDescription panel = parallelogram({-1, 1.8f, -1}, {0.8f, 0, 0}, {0, 0, 0.8f});
  for (const float part : {-1.f, 0.f, 1.f}) {
    swinging.moments.push_back(moved(swinging.to_world, part));
    view.camera.moments.push_back(moved(view.camera.to_world, 0.3f * part));
    MeshShape shape;
    for (const Vec3f& at : panel.positions) shape.positions.push_back(at + Vec3f(0, 0.3f * part, part));
    panel.moments.push_back(shape);
  }
  view.scene.add(swinging).add(panel, emitter(4));
  view.fog = {0.1f, Rgb(0.8f), 0, 4};
  view.resolution = 0.05;
  return view;
}

View seen_by(View view, CameraDescription::Kind kind, const PixelFilter& filter) {
  view.camera.kind = kind;
  view.camera.ymag = 0.8f;
  view.filter = filter;
  if (kind == CameraDescription::Kind::panorama) view.camera.to_world.origin = {0.6f, 0.9f, 0.3f};
  return view;
}
View by_parallel_rays() {
  return seen_by(lamps(), CameraDescription::Kind::orthographic, {PixelFilter::Kind::gaussian, 3});
}
View all_around() {
  return seen_by(lamps(), CameraDescription::Kind::panorama, {PixelFilter::Kind::blackman_harris, 2.5f});
}
View through_a_lens() {
  View view = seen_by(lamps(), CameraDescription::Kind::perspective, {PixelFilter::Kind::box, 0.6f});
  view.camera.lens_radius = 0.2f;
  view.camera.focus_distance = 2;
  return view;
}

class LightTracing : public testing::TestWithParam<View (*)()> {};

constexpr std::array views{
    room,           lamps,         sky,   flame_card_mask, flame_card_blend, screens,    layers,
    smooth_shading, frosted_glass, panes, aquarium,        by_parallel_rays, all_around, through_a_lens,
    foggy,          misty_sky,     milk,  moving};

// Welch's tests of every pixel, family significance 0.001.
TEST_P(LightTracing, AgreesWithPaths) {
  const double significance = sidak(1e-3, std::size(views));
  View view = GetParam()();
  Scene scene = view.scene.build();
  scene.fill_air(view.fog);
  double resolved = 0;
  const auto p_value = [&](uint64_t seed, uint64_t factor) {
    PictureCase picture{scene, view.camera, {}};
    picture.settings.width = picture.settings.height = 8;
    picture.settings.filter = view.filter;
    picture.settings.adaptive = false;
    picture.settings.integrator_options.max_depth = view.max_depth;
    picture.settings.integrator_options.caustics = Caustics::off;
    picture.settings.limits.spp = int(256 * factor / thinning);
    const auto by_paths = pixels_of(picture, 16, 1000 * seed);
    picture.settings.integrator = "light";
    picture.settings.limits.spp *= 8;
    const auto by_light = pixels_of(picture, 16, 1000 * seed + 500);
    resolved = resolution(by_paths, by_light, significance);
    return difference(by_paths, by_light);
  };
  EXPECT_TRUE(confirmed(significance, 1, p_value)) << view.name;
  // Rare bright splats make fewer samples resolve less than their number tells.
  EXPECT_LT(resolved, (thinning > 1 ? 2 * coarsening : 1) * view.resolution) << view.name;
}

INSTANTIATE_TEST_SUITE_P(Views, LightTracing, testing::ValuesIn(views));

}  // namespace
}  // namespace vernier::test
