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

MaterialDescription water() {
  MaterialDescription material = glass(0);
  material.ior = 1.33f;
  return material;
}

MeshDescription floor_mesh(float y = 0) { return parallelogram({-4, y, -4}, {0, 0, 8}, {8, 0, 0}); }

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

/// `error`: the standard error of what is expected.
::testing::AssertionResult agree(const Samples& found, double expected, double within, double error = 0) {
  const double allowed = coarsening * within * expected;
  if (detectable_bias(std::hypot(found.standard_error(), error), 1e-3) > allowed)
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
    EXPECT_TRUE(
        agree(chains_alone(scene, camera_at({0, 0.8f, 0.8f}, {0.1f, 0, 0}, 0.3f), 4096), expected, 0.015))
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
  const Scene scene = pool(0.002f).add(point_lamp({0, 2.1f, 0}, 10)).build();
  for (const double offset : {0.3, 1.5}) {
    const CameraDescription view = camera_at({float(offset), 0.6f, 0.5f}, {float(offset), 0.1f, 0}, 1e-3f);
    const double expected = 0.002 / std::numbers::pi * under_water(1, 1, offset, 10, double(1.33f));
    EXPECT_TRUE(agree(chains_alone(scene, view, 6144), expected, 0.02)) << offset;
  }
}

// All of it, by paths from the camera above the water. The ground lights itself by what the surface reflects
// to it, less than its reflectance.
TEST(Manifold, LampAboveWaterSeenFromAbove) {
  const Scene scene = pool(0.002f).add(point_lamp({0, 2.1f, 0}, 10)).build();
  const double n = double(1.33f), angle = 0.6, bent = std::asin(std::sin(angle) / n), offset = 0.8;
  const double surface_x = offset + std::tan(bent), above = 3;
  const Vec3f eye(float(surface_x + above * std::tan(angle)), 1.1f + float(above), 0.f);
  const CameraDescription view = camera_at(eye, {float(surface_x), 1.1f, 0}, 1e-3f);
  const double expected = 0.002 / std::numbers::pi * under_water(1, 1, offset, 10, n) / (n * n) *
                          (1 - reflectance(std::cos(angle), n));
  EXPECT_TRUE(agree(picture_mean(scene, view, "path", 192), expected, 0.02));
  EXPECT_LT(picture_mean(scene, view, "path", 16, Caustics::off, 2).mean(), 1e-3 * expected);
}

TEST(Manifold, LampInAMirror) {
  const Scene scene = SceneBuilder()
                          .add(floor_mesh(), diffuse(0.5f))
                          .add(parallelogram({1, 0, -4}, {0, 0, 8}, {0, 4, 0}), metal(0))
                          .add(point_lamp({0, 1, 0.5f}, 10))
                          .build();
  const Vec3f at(0.2f, 0, 0), to_lamp = Vec3f(2, 1, 0.5f) - at;
  const double expected =
      0.5 / std::numbers::pi * 10 * double(to_lamp.y) / std::pow(double(length(to_lamp)), 3);
  EXPECT_TRUE(agree(chains_alone(scene, camera_at({0, 2, 2}, at, 1e-3f), 16384), expected, 0.01));
}

/// A body beside or about a lamp, over a floor.
struct Body {
  const char* name;
  Vec3f lamp, center;
  std::vector<std::pair<float, float>> spheres;  ///< radius and index
  int rings;                                     ///< few: facets, many: smooth
  Vec3f looks_at;
  double within;
  int samples;
};
const Body bodies[] = {
    {"lens", {0, 2.5f, 0}, {0, 0.52f, 0}, {{0.5f, 1.2f}}, 48, {0.05f, 0, 0}, 0.05, 8192},
    {"facets", {0, 2.5f, 0}, {0, 0.9f, 0}, {{0.5f, 1.5f}}, 3, {0, 0, 0}, 0.09, 8192},
    {"bulb", {0, 1.5f, 0}, {0, 1.5f, 0}, {{0.5f, 1.5f}, {0.45f, 1.f}}, 48, {0, 0, 0.1f}, 0.05, 8192},
};

Scene scene_of(const Body& body) {
  SceneBuilder builder;
  builder.add(floor_mesh(), diffuse(0.01f));
  for (const auto& [radius, index] : body.spheres) {
    MaterialDescription material = glass(0);
    material.ior = index;
    const bool is_smooth = body.rings > 8;
    builder.add(is_smooth ? smooth_sphere(body.center, radius, body.rings, 2 * body.rings)
                          : sphere(body.center, radius, body.rings, 2 * body.rings),
                material);
  }
  return builder.add(point_lamp(body.lamp, 10)).build();
}

// What chains alone bring where light paths end too, beside direct light.
TEST(Manifold, AsLightPaths) {
  if (thinning > 1) GTEST_SKIP() << "fewer samples do not tell";
  for (const Body& body : bodies) {
    const CameraDescription view = camera_at({0, 0.15f, 1.2f}, body.looks_at, 0.08f);
    const Scene scene = scene_of(body);
    const double direct = picture_mean(scene, view, "path", 256, Caustics::off).mean();
    const Samples light = picture_mean(scene, view, "light", 2048);
    EXPECT_TRUE(agree(chains_alone(scene, view, body.samples), light.mean() - direct, body.within,
                      light.standard_error()))
        << body.name;
  }
}

/// Water of that depth with waves, closed all around.
MeshDescription wavy_water(float half_width, float depth, int cells) {
  MeshDescription mesh;
  const auto at = [&](int i) { return half_width * (2 * float(i) / float(cells) - 1); };
  const auto add_grid = [&](bool is_top) {
    const auto first = uint32_t(mesh.positions.size());
    for (int row = 0; row <= cells; ++row)
      for (int column = 0; column <= cells; ++column) {
        const float x = at(column), z = at(row), kx = 5, kz = 4;
        const float wave = is_top ? 0.03f : 0;
        mesh.positions.push_back(
            {x, (is_top ? depth : 0) + wave * std::sin(kx * x) * std::cos(kz * z + x), z});
        const float dx = wave * (kx * std::cos(kx * x) * std::cos(kz * z + x) -
                                 std::sin(kx * x) * std::sin(kz * z + x)),
                    dz = -wave * kz * std::sin(kx * x) * std::sin(kz * z + x);
        mesh.normals.push_back(normalize(is_top ? Vec3f(-dx, 1, -dz) : Vec3f(0, -1, 0)));
      }
    for (int row = 0; row < cells; ++row)
      for (int column = 0; column < cells; ++column) {
        const uint32_t a = first + uint32_t(row * (cells + 1) + column), b = a + 1,
                       c = a + uint32_t(cells) + 1, d = c + 1;
        const uint32_t second = is_top ? c : b, third = is_top ? b : c;
        mesh.triangles.push_back({a, second, third});
        mesh.triangles.push_back({d, third, second});
      }
  };
  add_grid(true);
  add_grid(false);
  const auto below = uint32_t((cells + 1) * (cells + 1));
  const auto add_side = [&](const std::function<uint32_t(int)>& vertex, const Vec3f& normal) {
    for (int i = 0; i < cells; ++i) {
      const auto first = uint32_t(mesh.positions.size());
      for (const uint32_t v : {vertex(i), vertex(i + 1), vertex(i) + below, vertex(i + 1) + below}) {
        mesh.positions.push_back(mesh.positions[v]);
        mesh.normals.push_back(normal);
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first + 3, first + 2, first + 1});
    }
  };
  const auto index = [&](int row, int column) { return uint32_t(row * (cells + 1) + column); };
  add_side([&](int i) { return index(0, i); }, {0, 0, -1});
  add_side([&](int i) { return index(cells, cells - i); }, {0, 0, 1});
  add_side([&](int i) { return index(cells - i, 0); }, {-1, 0, 0});
  add_side([&](int i) { return index(i, cells); }, {1, 0, 0});
  return mesh;
}

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

// Seen through waves, and in a mirror: what a lamp casts through waves, with all that the ground sends on, is
// what a small round lamp casts, which paths from the camera meet.
TEST(Manifold, AsOfASmallLamp) {
  if (thinning > 1) GTEST_SKIP() << "paths meet a small lamp too rarely";
  const Vec3f lamp(-1, 2.1f, 0);
  const auto pool_with = [](SceneBuilder scene) {
    return scene.add(parallelogram({-2, 0.1f, -2}, {0, 0, 4}, {4, 0, 0}), diffuse(0.4f))
        .add(wavy_water(2.5f, 1.1f, 40), water())
        .add(parallelogram({2.6f, 1.3f, -2}, {0, 0, 4}, {-0.8f, 2, 0}), metal(0));
  };
  SceneBuilder ball = pool_with({});
  add_small_lamp(ball, lamp, 0.25f, 10);
  const Scene of_ball = ball.build(), of_point = pool_with({}).add(point_lamp(lamp, 10)).build();
  for (const CameraDescription& view : {camera_at({1.2f, 4, 0}, {1, 0, 0.2f}, 0.15f),
                                        camera_at({0.2f, 2.6f, 0.3f}, {2.3f, 2, 0.3f}, 0.15f)}) {
    const Samples lit = picture_mean(of_point, view, "path", 256),
                  expected = picture_mean(of_ball, view, "path", 2048);
    EXPECT_LT(detectable_bias(std::hypot(lit.standard_error(), expected.standard_error()), 1e-3),
              0.06 * expected.mean());
    EXPECT_NEAR(lit.mean(), expected.mean(), 0.06 * expected.mean());
  }
}

}  // namespace
}  // namespace vernier::test
