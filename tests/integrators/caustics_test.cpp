// SPDX-License-Identifier: Apache-2.0
#include "integrators/light_emission.h"
#include "scene/camera.h"
#include "tests/support/effort.h"
#include "tests/support/pictures.h"

// Light of lamps by mirrors and through glass that bends it, which paths from lamps bring to a picture.

namespace vernier::test {
namespace {

MaterialDescription grey(MaterialDescription material, float reflectance) {
  material.base_color = {reflectance, reflectance, reflectance, 1};
  return material;
}

MeshDescription floor_mesh() { return parallelogram({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}); }

/// A small round lamp of about that intensity all around.
void add_small_lamp(SceneBuilder& scene, const Vec3f& at, float radius, float intensity) {
  const MeshDescription mesh = sphere(at, radius, 8, 16);
  float area = 0;
  for (const auto& t : mesh.triangles) {
    const auto& p = mesh.positions;
    area += length(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])) / 2;
  }
  // A convex body's projected area is a quarter of its surface in the mean over directions (Cauchy).
  scene.add(mesh, emitter(intensity * 4 / area));
}

PictureCase picture_of(const Scene& scene, const CameraDescription& camera, const char* integrator, int spp) {
  PictureCase picture{scene, camera, {}};
  picture.settings.width = picture.settings.height = 8;
  picture.settings.adaptive = false;
  picture.settings.integrator = integrator;
  picture.settings.integrator_options.caustics = Caustics::on;
  picture.settings.limits.spp = std::max(16, spp / thinning);
  return picture;
}

/// Of the whole picture, by its first channel.
Samples mean_of(const PictureCase& picture, int renders = 16, uint64_t seed = 1) {
  const auto pixels = pixels_of(picture, renders, seed);
  return pixels[pixels.size() - 3];
}

/// Reflectance of glass of index 1.5 at an angle (Fresnel's equations).
double reflectance(double cos_i) {
  const double cos_t = std::sqrt(1 - (1 - cos_i * cos_i) / (1.5 * 1.5));
  const double s = (cos_i - 1.5 * cos_t) / (cos_i + 1.5 * cos_t),
               p = (1.5 * cos_i - cos_t) / (1.5 * cos_i + cos_t);
  return (s * s + p * p) / 2;
}

// Between its two faces a pane sends light to and fro: of R a face, (1 - R) / (1 + R) gets through.
TEST(Caustics, SunThroughAThickPane) {
  for (const double angle : {0.0, 0.9}) {
    const Scene scene = SceneBuilder()
                            .add(parallelogram({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), diffuse(0.01f))
                            .add(box({-2.4f, 1, -1}, {0.8f, 1.3f, 1}), glass(0))
                            .add(sun({float(std::sin(angle)), -float(std::cos(angle)), 0}, 100))
                            .build();
    const CameraDescription camera = camera_at({0, 0.8f, 0.8f}, {0.1f, 0, 0}, 0.3f);
    PictureCase picture = picture_of(scene, camera, "path", 2048);
    const double r = reflectance(std::cos(angle));
    const double expected = 0.01 / std::numbers::pi * 100 * std::cos(angle) * (1 - r) / (1 + r);
    const Samples found = mean_of(picture);
    EXPECT_LT(detectable_bias(found.standard_error(), 1e-3), coarsening * 0.01 * expected);
    EXPECT_NEAR(found.mean(), expected, coarsening * 0.01 * expected) << angle;
    picture.settings.integrator_options.caustics = Caustics::off;
    EXPECT_LT(mean_of(picture, 2).mean(), 1e-3 * expected);
  }
}

// Light that stays in what bends it: radiance in water is greater by the squared index than what gets in, by
// the rays that get nearer to each other, and what a camera in the water shows is less by as much.
TEST(Caustics, SunIntoWaterWithACamera) {
  const Scene scene = SceneBuilder()
                          .add(parallelogram({-1, 0.1f, -1}, {0, 0, 2}, {2, 0, 0}), diffuse(0.002f))
                          .add(box({-1, 0, -1}, {1, 1, 1}), glass(0))
                          .add(sun({0, -1, 0}, 1000))
                          .build();
  const Samples found =
      mean_of(picture_of(scene, camera_at({0, 0.6f, 0.5f}, {0, 0.1f, 0}, 0.5f), "path", 1024));
  const double expected = 0.002 / std::numbers::pi * 1000 * (1 - reflectance(1)) / (1.5 * 1.5);
  EXPECT_LT(detectable_bias(found.standard_error(), 1e-3), coarsening * 0.01 * expected);
  EXPECT_NEAR(found.mean(), expected, coarsening * 0.01 * expected);
}

// A mirror shows the floor a second lamp.
TEST(Caustics, LampBesideAMirror) {
  const Scene scene = SceneBuilder()
                          .add(floor_mesh(), diffuse(0.01f))
                          .add(parallelogram({1, 0, -4}, {0, 0, 8}, {0, 4, 0}), metal(0))
                          .add(point_lamp({0, 1, 0.5f}, 10))
                          .build();
  const CameraDescription view = camera_at({0, 2, 2}, {0, 0, 0}, 0.3f);
  const Camera camera(view, 8, 8);
  double expected = 0;
  constexpr int steps = 64;
  for (int i = 0; i < steps * steps; ++i) {
    const int column = i % steps, row = i / steps;
    const Ray ray = camera.ray({8 * (float(column) + 0.5f) / steps, 8 * (float(row) + 0.5f) / steps});
    const Vec3f at = ray.at(-ray.origin.y / ray.direction.y);
    for (const Vec3f& lamp : {Vec3f(0, 1, 0.5f), Vec3f(2, 1, 0.5f)}) {
      const Vec3f to_lamp = lamp - at;
      expected += 0.01 / std::numbers::pi * 10 * double(to_lamp.y) / std::pow(double(length(to_lamp)), 3) /
                  (steps * steps);
    }
  }
  const Samples found = mean_of(picture_of(scene, view, "path", 256));
  EXPECT_LT(detectable_bias(found.standard_error(), 1e-3), coarsening * 0.005 * expected);
  EXPECT_NEAR(found.mean(), expected, coarsening * 0.005 * expected);
}

/// A lens on a floor, or a bulb about the lamp.
struct Body {
  const char* name;
  Vec3f lamp;
  std::vector<std::pair<float, float>> spheres;  ///< radius and index
  Vec3f center;
};
const Body bodies[] = {{"sphere", {0, 2.5f, 0}, {{0.5f, 1.5f}}, {0, 0.9f, 0}},
                       {"bulb", {0, 1.5f, 0}, {{0.5f, 1.5f}, {0.45f, 1.f}}, {0, 1.5f, 0}}};

SceneBuilder scene_of(const Body& body) {
  SceneBuilder scene;
  scene.add(floor_mesh(), grey(diffuse(1), 0.5f));
  for (const auto& [radius, index] : body.spheres) {
    MaterialDescription material = glass(0);
    material.ior = index;
    scene.add(sphere(body.center, radius, 16, 32), material);
  }
  return scene;
}

const CameraDescription under_the_body = camera_at({0, 0.5f, 2.2f}, {0, 0, 0.1f}, 0.25f);

// A lamp of some size, which paths from the camera meet, shines as it does for paths from lights; and as it
// shrinks, as the lamp that is a point. Family significance 0.001.
TEST(Caustics, AsOfASmallLamp) {
  if (thinning > 1) GTEST_SKIP() << "paths meet a small lamp too rarely";
  const double significance = sidak(1e-3, 2 * std::size(bodies));
  for (const Body& body : bodies) {
    SceneBuilder large = scene_of(body), small = scene_of(body), none = scene_of(body);
    add_small_lamp(large, body.lamp, 0.15f, 10);
    add_small_lamp(small, body.lamp, 0.02f, 10);
    const Scene large_lamp = large.build(), small_lamp = small.build();
    const Scene lamp = none.add(point_lamp(body.lamp, 10)).build();
    EXPECT_TRUE(confirmed(significance, 1, [&](uint64_t seed, uint64_t factor) {
      const int spp = 192 * int(factor);
      return difference(
          pixels_of(picture_of(large_lamp, under_the_body, "path", 8 * spp), 16, 1000 * seed),
          pixels_of(picture_of(large_lamp, under_the_body, "light", spp), 16, 1000 * seed + 500));
    })) << body.name;
    const Samples small_mean = mean_of(picture_of(small_lamp, under_the_body, "light", 3072));
    const Samples lamp_mean = mean_of(picture_of(lamp, under_the_body, "path", 768));
    // What is left of its size is in proportion to its square.
    EXPECT_NEAR(lamp_mean.mean(), small_mean.mean(), coarsening * 0.02 * small_mean.mean()) << body.name;
    EXPECT_LT(detectable_bias(std::hypot(lamp_mean.standard_error(), small_mean.standard_error()), 1e-3),
              coarsening * 0.02 * small_mean.mean())
        << body.name;
  }
}

/// Lamps, a sky and a lit pane among mirrors, glass, panes and polished things, of which the camera sees
/// none.
Scene mixed_scene() {
  MaterialDescription polished = grey(plastic(0), 0.6f);
  MaterialDescription coated = grey(glass(0), 1);
  coated.clearcoat = 1;
  MaterialDescription thin = grey(glass(0), 0.8f);
  thin.thickness = 0;
  MaterialDescription dispersing = glass(0);
  dispersing.dispersion = 10;
  dispersing.attenuation_color = {0.5f, 0.7f, 0.9f};
  dispersing.attenuation_distance = 0.5f;
  PunctualLightDescription near = point_lamp({-0.5f, 1.2f, -0.5f}, 6);
  near.range = 2.5f;
  MeshDescription smooth = sphere({-0.9f, 0.6f, 0.3f}, 0.3f, 6, 8);
  for (const Vec3f& at : smooth.positions) smooth.normals.push_back(normalize(at - Vec3f(-0.9f, 0.6f, 0.3f)));
  return SceneBuilder()
      .add(floor_mesh(), grey(plastic(0.6f), 0.5f))
      .add(box({0.6f, 0.2f, -0.4f}, {1.2f, 0.8f, 0.2f}), dispersing)
      .add(smooth, coated)
      .add(parallelogram({-1.5f, 0.01f, -1.5f}, {0, 1.5f, 0}, {3, 0, 0}), polished)
      .add(parallelogram({1.5f, 0, -1.5f}, {0, 1.5f, 0}, {0, 0, -3}), grey(metal(0), 0.9f))
      .add(parallelogram({-0.4f, 1.3f, -0.9f}, {0, 0.3f, 0.8f}, {0.8f, 0, 0}), thin)
      .add(near)
      .add(sun({0.5f, -1, -0.4f}, 2))
      .environment([](const Vec3f&) { return 0.2f; }, 4)
      .build();
}

// Each kind of path is found once: all that paths from lights find, and paths from the camera with the
// caustics of lamps. Welch's tests of every pixel, significance 0.001.
TEST(Caustics, NothingIsCountedTwice) {
  const Scene scene = mixed_scene();
  const CameraDescription view = camera_at({0, 1.1f, 0.6f}, {0, 0, 0}, 0.5f);
  double resolved = 0;
  EXPECT_TRUE(confirmed(1e-3, 1, [&](uint64_t seed, uint64_t factor) {
    PictureCase paths = picture_of(scene, view, "path", 1024 * int(factor));
    PictureCase light = picture_of(scene, view, "light", 8192 * int(factor));
    paths.settings.integrator_options.max_depth = light.settings.integrator_options.max_depth = 6;
    const auto a = pixels_of(paths, 16, 1000 * seed), b = pixels_of(light, 16, 1000 * seed + 500);
    resolved = resolution(a, b, 1e-3);
    return difference(a, b);
  }));
  EXPECT_LT(resolved, coarsening * 0.02);
}

MissingEstimate missing(const Scene& scene, const CameraDescription& view, Caustics caustics) {
  RenderSettings settings;
  settings.width = settings.height = 24;
  settings.integrator_options.caustics = caustics;
  const std::atomic<bool> stop = false;
  const auto integrator = make_integrator("path", settings.integrator_options);
  return render(scene, Camera(view, 24, 24), *integrator, settings, stop).missing;
}

// What light paths bring is missing no more, nor what mirrors show of it, but for what a normal texture
// bends.
TEST(Caustics, LedgerTellsWhatRemains) {
  SceneBuilder bulb = scene_of(bodies[1]).add(point_lamp(bodies[1].lamp, 10));
  const Scene scene = bulb.build();
  EXPECT_GT(missing(scene, under_the_body, Caustics::off).bent.share, 0.9);
  EXPECT_LT(missing(scene, under_the_body, Caustics::automatic).bent.share, 0.02);
  const Scene mirrored = bulb.add(parallelogram({-4, 0.1f, -4}, {0, 0, 8}, {8, 0, 0}), metal(0))
                             .add(box({-4, -1, -4}, {4, 4, 4}, true), diffuse(0.5f))
                             .build();
  EXPECT_GT(missing(mirrored, under_the_body, Caustics::off).bent.share, 0.5);
  EXPECT_LT(missing(mirrored, under_the_body, Caustics::on).bent.share, 0.02);
  MaterialDescription rippled = glass(0);
  rippled.normal_texture.texture = 0;
  const Scene mapped = bulb.texture(1, 1, {128})
                           .add(box({-3, 2.2f, -3}, {3, 2.3f, 3}), rippled)
                           .add(point_lamp({0, 2.5f, 0}, 100))
                           .build();
  EXPECT_GT(missing(mapped, under_the_body, Caustics::on).bent.share, 0.1);
}

// Light paths are followed where lamps shine on what mirrors or bends their light, and only there.
TEST(Caustics, AutomaticallyWhereThereAreSome) {
  const auto kind = [](SceneBuilder scene, const char* integrator = "path", Caustics caustics = {}) {
    IntegratorOptions options;
    options.caustics = caustics;
    return make_integrator(integrator, options)->light_paths(scene.build());
  };
  SceneBuilder plain;
  plain.add(floor_mesh(), plastic(0.5f));
  EXPECT_EQ(kind(SceneBuilder(plain).add(point_lamp({0, 1, 0}, 1))), LightPathKind::none);
  EXPECT_EQ(kind(SceneBuilder(plain).add(sphere({0, 1, 0}, 0.5f, 8, 8), glass(0))), LightPathKind::none);
  SceneBuilder lit =
      SceneBuilder(plain).add(sphere({0, 1, 0}, 0.5f, 8, 8), glass(0)).add(point_lamp({0, 2, 0}, 1));
  EXPECT_EQ(kind(lit), LightPathKind::caustics);
  EXPECT_EQ(kind(lit, "path", Caustics::off), LightPathKind::none);
  EXPECT_EQ(kind(lit, "whitted"), LightPathKind::none);
  EXPECT_EQ(kind(lit, "light"), LightPathKind::all);
  // Glass in the shadow of a floor is none of a lamp's.
  EXPECT_EQ(
      kind(SceneBuilder(plain).add(sphere({0, 1, 0}, 0.5f, 8, 8), glass(0)).add(point_lamp({0, -1, 0}, 1))),
      LightPathKind::none);
}

}  // namespace
}  // namespace vernier::test
