// SPDX-License-Identifier: Apache-2.0
#include "integrators/manifold.h"

#include "core/base/parallel.h"
#include "scene/camera.h"
#include "tests/support/effort.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"

// Light of lamps by chains of sharp reflections and refractions: where no path from a lamp can end for the
// camera, and, asked alone, where one can.

namespace vernier::test {
namespace {

PunctualLightDescription point(const Vec3f& at, float intensity) {
  PunctualLightDescription light;
  light.intensity = intensity;
  light.to_world.origin = at;
  return light;
}

PunctualLightDescription sun(const Vec3f& shines, float irradiance) {
  PunctualLightDescription light;
  light.kind = PunctualLightDescription::Kind::directional;
  light.intensity = irradiance;
  light.to_world.z = -normalize(shines);
  return light;
}

MaterialDescription water() {
  MaterialDescription material = glass(0);
  material.ior = 1.33f;
  return material;
}

MeshDescription floor_mesh(float y = 0) { return parallelogram({-4, y, -4}, {0, 0, 8}, {8, 0, 0}); }

/// Normals as those of a true sphere.
MeshDescription smooth_sphere(const Vec3f& center, float radius, int rings, int segments) {
  MeshDescription mesh = sphere(center, radius, rings, segments);
  for (const Vec3f& at : mesh.positions) mesh.normals.push_back(normalize(at - center));
  return mesh;
}

std::shared_ptr<const LightEmission> lamps_of(const Scene& scene) {
  return std::make_shared<LightEmission>(LightEmission::of_lamps(scene));
}

/// What chains alone bring to the surfaces that a camera sees straight, over its whole picture: means of
/// `sets` times `samples`.
Samples chains_alone(const Scene& scene, const CameraDescription& view, int samples, int sets = 32) {
  const SpecularChains chains(scene, lamps_of(scene));
  const Camera camera(view, 8, 8);
  std::vector<double> means(size_t(sets), 0);
  parallel_for(means.size(), [&](size_t set) {
    Random random(set + 1);
    RayCounts rays;
    for (int i = 0; i < samples; ++i) {
      const Vec2f raster = random.next2() * 8.f;
      const Segment segment = camera_segment(scene, camera.ray(raster));
      const auto hit = intersect_from_camera(scene, segment);
      if (!hit) continue;
      const Shading surface = shade(scene, *hit, -segment.ray.direction);
      const Rgb throughput(1, 1, 1);
      const auto light = chains.sample({*hit, surface, throughput, 0}, set << 32 | uint64_t(i), rays);
      if (light) means[set] += double(light->radiance.x) / samples;
    }
  });
  Samples result;
  for (const double mean : means) result.add(mean);
  return result;
}

/// The picture's mean by an integrator, and by chains beside it.
Samples picture_mean(const Scene& scene, const CameraDescription& view, const char* integrator, int spp,
                     Caustics caustics = Caustics::on, int renders = 16) {
  PictureCase picture{scene, view, {}};
  picture.settings.width = picture.settings.height = 8;
  picture.settings.adaptive = false;
  picture.settings.integrator = integrator;
  picture.settings.integrator_options.caustics = caustics;
  picture.settings.limits.spp = std::max(16, spp / thinning);
  const auto pixels = pixels_of(picture, renders, 1);
  return pixels[pixels.size() - 3];
}

::testing::AssertionResult agree(const Samples& found, double expected, double within) {
  const double allowed = coarsening * within * expected;
  if (detectable_bias(found.standard_error(), 1e-3) > allowed)
    return ::testing::AssertionFailure() << found.mean() << " +- " << found.standard_error() << ", expected "
                                         << expected << ": too noisy to tell " << allowed;
  if (std::abs(found.mean() - expected) > allowed)
    return ::testing::AssertionFailure() << found.mean() << " +- " << found.standard_error() << ", expected "
                                         << expected << " within " << allowed;
  return ::testing::AssertionSuccess();
}

/// Reflectance of a boundary of relative index n (Fresnel's equations).
double reflectance(double cos_i, double n) {
  const double cos_t = std::sqrt(1 - (1 - cos_i * cos_i) / (n * n));
  const double s = (cos_i - n * cos_t) / (cos_i + n * cos_t), p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
  return (s * s + p * p) / 2;
}

// Through both faces, to and fro between them: of R a face, (1 - R) / (1 + R) gets through.
TEST(Manifold, SunThroughAThickPane) {
  for (const double angle : {0.0, 0.9}) {
    const Scene scene = SceneBuilder()
                            .add(parallelogram({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), diffuse(0.5f))
                            .add(box({-2.4f, 1, -1}, {0.8f, 1.3f, 1}), glass(0))
                            .add(sun({float(std::sin(angle)), -float(std::cos(angle)), 0}, 100))
                            .build();
    const double r = reflectance(std::cos(angle), 1.5);
    const double expected = 0.5 / std::numbers::pi * 100 * std::cos(angle) * (1 - r) / (1 + r);
    EXPECT_TRUE(agree(chains_alone(scene, camera_at({0, 0.8f, 0.8f}, {0.1f, 0, 0}, 0.3f), 4096), expected, 0.01))
        << angle;
  }
}

// A lamp above water: its light spreads otherwise below the surface. Flux of a ring of directions over the
// ring of the ground that it arrives at.
double under_water(double lamp_height, double depth, double offset, double intensity, double n) {
  double low = 0, high = std::numbers::pi / 2;
  const auto reach = [&](double angle) {
    return lamp_height * std::tan(angle) + depth * std::tan(std::asin(std::sin(angle) / n));
  };
  for (int i = 0; i < 100; ++i) (reach((low + high) / 2) < offset ? low : high) = (low + high) / 2;
  const double angle = (low + high) / 2, h = 1e-5;
  const double slope = (reach(angle + h) - reach(angle - h)) / (2 * h);
  return intensity * (1 - reflectance(std::cos(angle), n)) * std::sin(angle) / (offset * slope);
}

SceneBuilder pool(float reflectance) {
  return SceneBuilder()
      .add(parallelogram({-3, 0.1f, -3}, {0, 0, 6}, {6, 0, 0}), diffuse(reflectance))
      .add(box({-3, 0, -3}, {3, 1.1f, 3}), water());
}

TEST(Manifold, LampAboveWaterSeenFromWithin) {
  const Scene scene = pool(0.002f).add(point({0, 2.1f, 0}, 10)).build();
  for (const double offset : {0.3, 1.5}) {
    const CameraDescription view = camera_at({float(offset), 0.6f, 0.5f}, {float(offset), 0.1f, 0}, 1e-3f);
    const double expected = 0.002 / std::numbers::pi * under_water(1, 1, offset, 10, double(1.33f));
    EXPECT_TRUE(agree(chains_alone(scene, view, 2048), expected, 0.01)) << offset;
  }
}

// All of it, by paths from the camera above the water. The ground lights itself by what the surface reflects
// to it, less than its reflectance.
TEST(Manifold, LampAboveWaterSeenFromAbove) {
  const Scene scene = pool(0.002f).add(point({0, 2.1f, 0}, 10)).build();
  const double n = double(1.33f), angle = 0.6, bent = std::asin(std::sin(angle) / n), offset = 0.8;
  const double surface_x = offset + std::tan(bent), above = 3;
  const Vec3f eye(float(surface_x + above * std::tan(angle)), 1.1f + float(above), 0.f);
  const CameraDescription view = camera_at(eye, {float(surface_x), 1.1f, 0}, 1e-3f);
  const double expected = 0.002 / std::numbers::pi * under_water(1, 1, offset, 10, n) / (n * n) *
                          (1 - reflectance(std::cos(angle), n));
  EXPECT_TRUE(agree(picture_mean(scene, view, "path", 64), expected, 0.01));
  EXPECT_LT(picture_mean(scene, view, "path", 16, Caustics::off, 2).mean(), 1e-3 * expected);
}

TEST(Manifold, LampInAMirror) {
  const Scene scene = SceneBuilder()
                          .add(floor_mesh(), diffuse(0.5f))
                          .add(parallelogram({1, 0, -4}, {0, 0, 8}, {0, 4, 0}), metal(0))
                          .add(point({0, 1, 0.5f}, 10))
                          .build();
  const Vec3f at(0.2f, 0, 0), to_lamp = Vec3f(2, 1, 0.5f) - at;
  const double expected =
      0.5 / std::numbers::pi * 10 * double(to_lamp.y) / std::pow(double(length(to_lamp)), 3);
  EXPECT_TRUE(agree(chains_alone(scene, camera_at({0, 2, 2}, at, 1e-3f), 512), expected, 0.01));
}

/// A lens on a floor, a bulb about the lamp, a bowl.
struct Body {
  const char* name;
  Vec3f lamp;
  bool is_smooth;
  std::vector<std::pair<float, float>> spheres;  ///< radius and index, 0: mirror
  Vec3f center;
  double within;  ///< relative
  int samples;
};
const Body bodies[] = {
    {"smooth sphere", {0, 2.5f, 0}, true, {{0.5f, 1.5f}}, {0, 0.9f, 0}, 0.02, 8192},
    {"flat sphere", {0, 2.5f, 0}, false, {{0.5f, 1.5f}}, {0, 0.9f, 0}, 0.03, 8192},
    {"smooth bulb", {0, 1.5f, 0}, true, {{0.5f, 1.5f}, {0.45f, 1.f}}, {0, 1.5f, 0}, 0.02, 8192},
    {"mirror ball", {1.5f, 1.2f, 0.3f}, true, {{0.5f, 0.f}}, {-0.8f, 0.6f, 0}, 0.02, 8192},
};

// What chains alone bring where light paths end too, and there is no other light.
TEST(Manifold, AsLightPaths) {
  const CameraDescription below = camera_at({0, 0.5f, 2.2f}, {0, 0, 0.1f}, 0.25f);
  for (const Body& body : bodies) {
    SceneBuilder builder;
    builder.add(floor_mesh(), diffuse(0.01f));
    for (const auto& [radius, index] : body.spheres) {
      MaterialDescription material = index > 0 ? glass(0) : metal(0);
      material.ior = index;
      builder.add(body.is_smooth ? smooth_sphere(body.center, radius, 16, 32)
                                 : sphere(body.center, radius, 16, 32),
                  material);
    }
    const Scene scene = builder.add(point(body.lamp, 10)).build();
    const Samples direct = picture_mean(scene, below, "path", 256, Caustics::off);
    const Samples light = picture_mean(scene, below, "light", 8192);
    const Samples chains = chains_alone(scene, below, body.samples / thinning);
    std::printf("%s: light %g +- %g, direct %g, chains %g +- %g\n", body.name, light.mean(),
                light.standard_error(), direct.mean(), chains.mean(), chains.standard_error());
    EXPECT_TRUE(agree(chains, light.mean() - direct.mean(), body.within)) << body.name;
  }
}

}  // namespace
}  // namespace vernier::test
