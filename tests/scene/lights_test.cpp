// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/sampling/warp.h"
#include "scene/lights/environment.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/test_scenes.h"

// Every kind of light: what sample() says, eval() says of the same direction, and the choice among lights is
// a probability.

namespace vernier::test {
namespace {

/// A floor and lights of all kinds above it, none of which hides another from most places; `lamps` x `lamps`
/// emissive parallelograms.
Scene lit_floor(int lamps) {
  SceneBuilder builder;
  builder.add(parallelogram({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}), diffuse(0.5f));
  for (int i = 0; i < lamps; ++i)
    for (int j = 0; j < lamps; ++j) {
      MaterialDescription material = emitter(float(1 + i + 2 * j));
      material.double_sided = (i + j) % 2;
      const Vec3f at(4 * float(i) / float(lamps) - 2, 1 + 0.1f * float(i * j % 5),
                     4 * float(j) / float(lamps) - 2);
      const float size = 1.5f / float(lamps);
      builder.add(parallelogram(at, {size, 0.3f * size, 0}, {0, 0.2f * size * float(j - 1), size}), material);
    }
  for (const auto kind : {PunctualLightDescription::Kind::point, PunctualLightDescription::Kind::spot,
                          PunctualLightDescription::Kind::directional}) {
    PunctualLightDescription light;
    light.kind = kind;
    light.intensity = 2;
    light.to_world = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0.3f, 2.5f, 0.1f}};
    builder.add(light);
  }
  return builder.environment([](const Vec3f& w) { return 0.1f + w.x * w.x + (w.y > 0.9f ? 5.f : 0.f); }, 32)
      .build();
}

std::vector<SurfacePoint> floor_points(const Scene& scene, int count) {
  std::vector<SurfacePoint> points;
  Random random(17);
  while (int(points.size()) < count) {
    const Vec2f u = random.next2();
    const Vec3f at(8 * u.x - 4, 0, 8 * u.y - 4);
    if (const auto hit = scene.intersect(ray_through(at + Vec3f(0.01f, 0.5f, 0.02f), at));
        hit && hit->instance == 0)
      points.push_back(*hit);
  }
  return points;
}

// The same direction met by a ray: the same radiance and the same density, the choice of light included.
TEST(Lights, SampleAgreesWithEval) {
  for (const int lamps : {1, 4}) {
    const Scene scene = lit_floor(lamps);
    Random random(3);
    int met = 0, delta = 0;
    for (const SurfacePoint& from : floor_points(scene, 400)) {
      const float u = random.next1();
      const auto sample = scene.sample_light(from, u, random.next2());
      if (!sample) continue;
      ASSERT_NEAR(length(sample->wi), 1, 1e-5);
      ASSERT_GT(sample->pdf, 0);
      if (sample->is_delta) {
        ++delta;
        continue;
      }
      if (sample->wi.y <= 0.02f || scene.occluded(sample->shadow)) continue;
      const Ray ray = from.spawn(sample->wi);
      const auto hit = scene.intersect(ray);
      const LightEval eval = scene.emitted(&from, ray, hit ? &*hit : nullptr);
      ++met;
      EXPECT_NEAR(eval.pdf, sample->pdf, 2e-3f * sample->pdf);
      EXPECT_NEAR(eval.radiance.x, sample->radiance.x, 1e-3f * sample->radiance.x);
    }
    EXPECT_GT(met, 100);
    EXPECT_GT(delta, 10);
  }
}

// The same for lamps alone, which are chosen rarely where there is a sky; a coat's reflectance, and so the
// emission below it, depends on the angle.
TEST(Lights, SampleAgreesWithEvalOfCoatedLamps) {
  MaterialDescription coated = emitter(3);
  coated.clearcoat = 1;
  const Scene scene = SceneBuilder()
                          .add(parallelogram({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}), diffuse(0.5f))
                          .add(parallelogram({-1, 1, -1}, {1, 0, 0}, {0, 0.2f, 1}), coated)
                          .add(parallelogram({0.5f, 0.8f, 0}, {1, 0.3f, 0}, {0, 0, 1}), emitter(2))
                          .build();
  Random random(3);
  int met = 0;
  for (const SurfacePoint& from : floor_points(scene, 400)) {
    const float u = random.next1();
    const auto sample = scene.sample_light(from, u, random.next2());
    if (!sample || sample->wi.y <= 0.02f || scene.occluded(sample->shadow)) continue;
    const Ray ray = from.spawn(sample->wi);
    const auto hit = scene.intersect(ray);
    ASSERT_TRUE(hit);
    const LightEval eval = scene.emitted(&from, ray, &*hit);
    ++met;
    EXPECT_NEAR(eval.pdf, sample->pdf, 2e-3f * sample->pdf);
    EXPECT_NEAR(eval.radiance.x, sample->radiance.x, 1e-3f * sample->radiance.x);
  }
  EXPECT_GT(met, 100);
}

/// A floor with one lamp standing on it: `material` on a parallelogram from (-1, 0, -0.5) on, leaning over.
SceneBuilder standing_lamp(const MaterialDescription& material) {
  return SceneBuilder()
      .add(parallelogram({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}), diffuse(0.5f))
      .add(parallelogram({-1, 0, -0.5f}, {2, 0, 0.3f}, {-0.2f, 1, 0.4f}), material);
}

MaterialDescription textured_emitter(float radiance) {
  MaterialDescription material = emitter(radiance);
  material.emissive_texture.texture = 0;
  return material;
}

/// Mostly dark, with a few lit texels; 45 a side, whose edges are not those of any table of cells.
std::vector<uint8_t> few_lit_texels() {
  std::vector<uint8_t> texels(45 * 45, 0);
  for (const int lit : {70, 71, 134, 1000, 1503}) texels[size_t(lit)] = 255;
  for (int i = 1600; i < 1800; ++i) texels[size_t(i)] = 90;
  return texels;
}

// Two triangles of a quad are one light, unless a texture tells them apart.
TEST(Lights, HalvesOfAParallelogramAreOneLight) {
  EXPECT_EQ(standing_lamp(emitter(1)).build().lights().size(), 1u);
  EXPECT_EQ(standing_lamp(textured_emitter(1)).texture(1, 1, {255}).build().lights().size(), 2u);
  MeshDescription bent = parallelogram({0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  bent.positions[2] += Vec3f(0, 1e-4f, 0);
  EXPECT_EQ(SceneBuilder().add(bent, emitter(1)).build().lights().size(), 2u);
}

// From places on the floor, up to the lamp's own edge: sampling and evaluation agree, and the directions
// sampled fit the density, cell by cell of the lamp.
TEST(Lights, NearAndTexturedLampsFitTheirDensity) {
  const auto check = [](const Scene& scene, const Vec3f& at, const char* name) {
    const auto from = scene.intersect(ray_through(at + Vec3f(0.001f, 0.2f, 0.002f), at));
    ASSERT_TRUE(from && from->instance == 0) << name << at;
    constexpr int cells = 16, samples = 100'000, sub = 45;
    std::vector<double> expected(2 * cells * cells), observed(expected.size());
    // A grid over both triangles; what the density says of each cell.
    const auto cell = [&](const SurfacePoint& on) {
      const Vec2f u = invert_sample_triangle({on.u, on.v});
      const int x = std::clamp(int(u.x * cells), 0, cells - 1),
                y = std::clamp(int(u.y * cells), 0, cells - 1);
      return size_t(on.primitive) * cells * cells + size_t(y * cells + x);
    };
    double total = 0;
    for (uint32_t primitive = 0; primitive < 2; ++primitive) {
      const auto corners = scene.geometry().triangle(1, primitive);
      const float area = length(cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
      for (int i = 0; i < cells * sub * cells * sub; ++i) {
        const int column = i % (cells * sub), row = i / (cells * sub);
        const Vec2f u((float(column) + 0.5f) / (cells * sub), (float(row) + 0.5f) / (cells * sub));
        SurfacePoint on = scene.geometry().surface_point(1, primitive, sample_triangle(u));
        const Vec3f to = on.position - from->position;
        const Vec3f wi = normalize(to);
        on.front = dot(on.ng, wi) < 0;
        const LightEval eval = scene.emitted(&*from, from->spawn(wi), &on);
        const double part = double(eval.pdf) * area * std::abs(dot(on.ng, wi)) / length_squared(to) /
                            (double(cells) * sub * cells * sub);
        expected[cell(on)] += part * samples;
        total += part;
      }
    }
    int dark = 0, apart = 0;
    Random random(41);
    for (int i = 0; i < samples; ++i) {
      const float u = random.next1();
      const auto sample = scene.sample_light(*from, u, random.next2());
      if (!sample) {
        ++dark;
        continue;
      }
      const auto hit = scene.intersect(from->spawn(sample->wi));
      if (!hit || hit->instance != 1) continue;  // by the edge, within rounding
      ++observed[cell(*hit)];
      const LightEval eval = scene.emitted(&*from, from->spawn(sample->wi), &*hit);
      apart += !(std::abs(eval.pdf / sample->pdf - 1) < 1e-3f);
    }
    // By the edges of a texture's cells, rounding may tell them apart.
    EXPECT_LE(apart, scene.lights().size() == 1 ? 0 : samples / 1000) << name << at;
    EXPECT_NEAR(total, 1 - double(dark) / samples, 0.01) << name << at;
    EXPECT_GT(chi_square_p_value(observed, expected), 1e-5) << name << at;
  };
  const Scene plain = standing_lamp(emitter(2)).build();
  const Scene textured = standing_lamp(textured_emitter(2)).texture(45, 45, few_lit_texels()).build();
  for (const Vec3f& at : {Vec3f(0, 0, 1), Vec3f(0.3f, 0, 0.1f), Vec3f(-0.9f, 0, -0.4f), Vec3f(4, 0, 6)}) {
    check(plain, at, "plain ");
    check(textured, at, "textured ");
  }
}

// Texels are where the triangles' barycentrics put them, whichever way round an instance turns its corners.
TEST(Lights, AMirroredLampShinesFromItsLitTexels) {
  const SceneBuilder lamp = standing_lamp(textured_emitter(2)).texture(45, 45, few_lit_texels());
  SceneDescription description = lamp.description();
  InstanceDescription mirrored = description.instances.back();
  mirrored.to_world = {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3, 0, 0}};
  description.instances.push_back(mirrored);
  const Scene scene(std::move(description), {});
  const auto from = scene.intersect(ray_through({3, 0.2f, 2}, {3, 0, 2}));
  ASSERT_TRUE(from);
  Random random(43);
  int met = 0, apart = 0;
  for (int i = 0; i < 20'000; ++i) {
    const float u = random.next1();
    const auto sample = scene.sample_light(*from, u, random.next2());
    if (!sample) continue;
    const Ray ray = from->spawn(sample->wi);
    const auto hit = scene.intersect(ray);
    if (!hit || hit->instance != 2) continue;
    const LightEval eval = scene.emitted(&*from, ray, &*hit);
    ++met;
    apart += !(std::abs(eval.radiance.x - sample->radiance.x) <= 1e-3f &&
               std::abs(eval.pdf / sample->pdf - 1) < 1e-3f);
  }
  EXPECT_GT(met, 5000);
  // By the edges of texels, rounding may tell them apart.
  EXPECT_LE(apart, met / 500);
}

// Integral over all directions of the density with which light sampling picks them: one, less the probability
// of lights that no ray meets, and of samples that come to nothing because a lamp's dark side faces the point
// or another lamp hides it.
TEST(Lights, PdfIntegratesToTheProbabilityOfBeingMet) {
  for (const int lamps : {1, 4}) {
    const Scene scene = lit_floor(lamps);
    for (const SurfacePoint& from : floor_points(scene, 2)) {
      Random random(23);
      double below = 0, above = 0, sampled = 0;
      constexpr int grid = int(1200 / test::coarsening), samples = 200'000 / test::thinning;
      for (int i = 0; i < grid * grid; ++i) {
        const int column = i % grid, row = i / grid;
        const float z = (float(column) + random.next1()) / grid,
                    phi = 2 * pi * (float(row) + random.next1()) / grid;
        const float r = safe_sqrt(1 - z * z);
        const Vec3f up(r * std::cos(phi), z, r * std::sin(phi)), down(up.x, -z, up.z);
        const Ray ray = from.spawn(up);
        const auto hit = scene.intersect(ray);
        above += scene.emitted(&from, ray, hit ? &*hit : nullptr).pdf;
        below += scene.emitted(&from, from.spawn(down), nullptr).pdf;
      }
      for (int i = 0; i < samples; ++i) {
        const float u = random.next1();
        const auto sample = scene.sample_light(from, u, random.next2());
        if (!sample || sample->is_delta) continue;
        if (sample->wi.y < 0 || !scene.occluded(sample->shadow)) sampled += 1.0 / samples;
      }
      EXPECT_NEAR((above + below) * 2 * std::numbers::pi / (grid * grid), sampled, 6e-3 * test::coarsening);
    }
  }
}

TEST(Lights, ChoiceIsAProbability) {
  for (const int lamps : {1, 4}) {
    const Scene scene = lit_floor(lamps);
    const LightSet& lights = scene.lights();
    ASSERT_EQ(lights.size(), size_t(lamps * lamps + 4));
    Random random(29);
    for (const SurfacePoint& from : floor_points(scene, 20)) {
      const LightReceiver receiver{from.position, from.ng};
      double sum = 0;
      std::vector<double> expected, counted(lights.size());
      for (size_t i = 0; i < lights.size(); ++i) {
        expected.push_back(lights.prob(receiver, i));
        sum += expected.back();
        // A light that shines on the point has to be found.
        const auto sample = lights[i].sample(from, {0.4f, 0.3f});
        if (sample && sample->wi.y > 0 && !is_black(sample->radiance)) {
          EXPECT_GT(expected.back(), 0) << i;
        }
      }
      EXPECT_NEAR(sum, 1, 1e-4);
      constexpr int samples = 20'000;
      for (int s = 0; s < samples; ++s) {
        const auto choice = lights.choose(receiver, random.next1());
        size_t i = 0;
        while (i < lights.size() && &lights[i] != choice.light) ++i;
        ASSERT_LT(i, lights.size());
        ASSERT_NEAR(choice.prob, expected[i], 1e-4f * choice.prob);
        ++counted[i];
      }
      for (double& e : expected) e *= samples;
      EXPECT_GT(chi_square_p_value(counted, expected), 1e-4);
    }
  }
}

EnvironmentLight environment(int width, int height, const std::function<float(int, int)>& texel) {
  auto picture = std::make_shared<Image>(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) picture->pixel(x, y)[c] = texel(x, y);
  auto description = std::make_shared<EnvironmentDescription>();
  description->picture = picture;
  description->rotation = 0.8f;
  return EnvironmentLight(description);
}

/// Integral of the pdf over the sphere, on a grid finer than any picture here.
double pdf_integral(const EnvironmentLight& light) {
  constexpr int rows = 720, columns = 1440;
  double sum = 0;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double theta = std::numbers::pi * (i + 0.5) / rows,
                   phi = 2 * std::numbers::pi * (j + 0.5) / columns;
      const Vec3f w(float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)),
                    float(std::sin(theta) * std::sin(phi)));
      sum += light.eval({}, w, nullptr).pdf * std::sin(theta);
    }
  return sum * 2 * std::numbers::pi * std::numbers::pi / (double(rows) * columns);
}

void expect_consistent(const EnvironmentLight& light) {
  EXPECT_NEAR(pdf_integral(light), 1, 2e-3);
  Random random(31);
  for (int i = 0; i < 2000; ++i) {
    const auto sample = light.sample({}, random.next2());
    if (!sample) continue;
    ASSERT_TRUE(is_finite(sample->radiance) && std::isfinite(sample->pdf) && sample->pdf > 0);
    const LightEval eval = light.eval({}, sample->wi, nullptr);
    // The picture's columns run together at the poles, where a direction in float does not tell them apart.
    if (std::abs(sample->wi.y) > 0.9999f) continue;
    ASSERT_NEAR(eval.pdf, sample->pdf, 0.01f * sample->pdf) << sample->wi;
  }
}

TEST(EnvironmentLight, PdfIntegratesToOne) {
  expect_consistent(environment(64, 32, [](int x, int y) { return 1.f + float((x * 7 + y * 3) % 11); }));
  expect_consistent(environment(1, 1, [](int, int) { return 2.f; }));
  expect_consistent(environment(32, 16, [](int, int y) { return y == 0 || y == 15 ? 1.f : 0.f; }));  // poles
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const EnvironmentLight holed =
      environment(32, 16, [&](int x, int y) { return x == 3 && y == 5 ? nan : 1.f; });
  expect_consistent(holed);
  EXPECT_EQ(holed.bad_texels(), 3u);
}

TEST(EnvironmentLight, BlackIsNeverSampled) {
  const EnvironmentLight black = environment(8, 4, [](int, int) { return 0.f; });
  EXPECT_FALSE(black.sample({}, {0.5f, 0.5f}));
  EXPECT_EQ(black.eval({}, {0, 1, 0}, nullptr).pdf, 0);
  EXPECT_EQ(black.power({}), 0);
}

// An unclipped sun in a picture of 8192 columns: light sampling alone finds the sky as bright as it is, above
// the sun and beside it. Few numbers lead there, so only those that may are drawn: one below 1/500 for the
// row, and for the column.
TEST(EnvironmentLight, SkyBesideASunIsSampledWithoutBias) {
  constexpr int width = 8192, height = 16, sun_row = 7;
  const EnvironmentLight sky = environment(width, height, [](int x, int y) {
    return y == sun_row && x >= 3000 && x < 3004 ? 1e8f : 1 + float(x % 8);
  });
  constexpr double mean = 4.5, few = 0.002, left = 2944. / width;
  const double top = std::cos(std::numbers::pi * (sun_row - 1) / height),
               bottom = std::cos(std::numbers::pi * (sun_row + 2) / height);
  Random random(7);
  const auto estimate = [&](const Vec2d& u, bool above) {
    const auto sample = sky.sample({}, u);
    if (!sample) return 0.;
    const double turn =
        (std::atan2(double(sample->wi.z), double(sample->wi.x)) + 0.8) / (2 * std::numbers::pi) + 0.5;
    const bool counts = above ? sample->wi.y > top
                              : sample->wi.y < top && sample->wi.y > bottom && turn - std::floor(turn) < left;
    return counts ? double(sample->radiance.x) / sample->pdf : 0;
  };
  Samples above, beside;
  for (int i = 0; i < 400'000 / thinning; ++i) {
    const double fine = random.next1() + random.next1() * 0x1p-24;
    above.add(few * estimate({random.next1(), few * fine}, true));
    beside.add(few * estimate({few * fine, random.next1()}, false));
  }
  const double all_around = 2 * std::numbers::pi * mean;
  EXPECT_GT(mean_p_value(above, all_around * (1 - top)), 1e-4);
  EXPECT_GT(mean_p_value(beside, all_around * left * (top - bottom)), 1e-4);
  EXPECT_LT(above.standard_error(), 0.01 * coarsening * above.mean());
  EXPECT_LT(beside.standard_error(), 0.03 * coarsening * beside.mean());
}

// One texel of 10^6: samples go there, and their mean weight is its irradiance with hardly any noise.
TEST(EnvironmentLight, SingleTexelIsSampledWithoutFireflies) {
  const EnvironmentLight sun =
      environment(256, 128, [](int x, int y) { return x == 100 && y == 40 ? 1e6f : 0; });
  Samples weights;
  Random random(37);
  double largest = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto sample = sun.sample({}, random.next2());
    ASSERT_TRUE(sample);
    weights.add(sample->radiance.x / sample->pdf);
    largest = std::max(largest, double(sample->radiance.x / sample->pdf));
  }
  const double theta = std::numbers::pi * 40.5 / 128, step = std::numbers::pi / 128;
  EXPECT_NEAR(weights.mean(), 1e6 * step * step * std::sin(theta), 0.03 * weights.mean());
  // The density of a cell is the mean of the interpolated picture over it. At the corner where a cell touches
  // the lit texel diagonally that mean is 1/64 and the radiance 1/4, and no ratio is larger. The mean square
  // of the ratio is 13/9 for each axis, so the variance is (13/9)^2 - 1 of the mean's square.
  EXPECT_LE(largest, 16.1 * weights.mean());
  EXPECT_NEAR(weights.variance() / (weights.mean() * weights.mean()), 13. * 13 / 81 - 1, 0.08);
}

// glTF has no say here, so the convention is stated and held: u = atan2(z, x) / 2 pi + 1/2, v = acos(y) / pi,
// and a rotation turns the picture counter-clockwise about +y.
TEST(EnvironmentLight, Orientation) {
  auto picture = std::make_shared<Image>(8, 4, 3);
  for (int c = 0; c < 3; ++c)
    picture->pixel(4, 2)[c] = 1;  // azimuths 0 to 45 degrees toward +z, just under the horizon
  auto description = std::make_shared<EnvironmentDescription>();
  description->picture = picture;
  const auto direction_of_light = [&] {
    const EnvironmentLight light(description);
    Vec3f brightest(0, 0, 0);
    float most = 0;
    for (int i = 0; i < 360; ++i)
      for (int j = 0; j < 180; ++j) {
        const float phi = float(i) * pi / 180, theta = float(j) * pi / 180;
        const Vec3f w(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
        if (light.radiance(w).x > most) {
          most = light.radiance(w).x;
          brightest = w;
        }
      }
    return brightest;
  };
  const float down = std::cos(112.5f * pi / 180), out = std::sin(112.5f * pi / 180);
  const float a = 22.5f * pi / 180;
  EXPECT_LT(length(direction_of_light() - Vec3f(out * std::cos(a), down, out * std::sin(a))), 0.03f);
  // A quarter turn counter-clockwise seen from above takes +x to -z.
  description->rotation = pi / 2;
  EXPECT_LT(length(direction_of_light() - Vec3f(out * std::sin(a), down, -out * std::cos(a))), 0.03f);
}

// What lights emit is their power, in the mean over rays, each of which begins where it says and shines on
// the scene.
TEST(Lights, EmitTheirPower) {
  const Scene scene = lit_floor(3);
  for (size_t i = 0; i < scene.lights().size(); ++i) {
    const Light& light = scene.lights()[i];
    constexpr int side = 256;
    double sum = 0;
    Random random(i + 1);
    for (int k = 0; k < side * side; ++k) {
      const int column = k % side, row = k / side;
      const Vec2d place((column + double(random.next1())) / side, (row + double(random.next1())) / side);
      const auto ray = light.emit(scene.bounds(), place, random.next2(), middle_of_shutter);
      if (!ray) continue;
      EXPECT_NEAR(length(ray->ray.direction), 1, 1e-5);
      sum += double(luminance(ray->flux)) / (side * side);
    }
    EXPECT_NEAR(sum, double(light.power(scene.bounds())), 0.01 * sum) << i;
  }
}

}  // namespace
}  // namespace vernier::test
