// SPDX-License-Identifier: Apache-2.0
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "scene/segment.h"
#include "tests/support/test_scenes.h"

// Light that media scatter, against closed forms, quadrature and itself.

namespace vernier::test {
namespace {

constexpr double pi_d = std::numbers::pi;

IntegratorOptions deep(int max_depth = 64) {
  IntegratorOptions options;
  options.max_depth = max_depth;
  return options;
}

/// A boundary of the index of air, or of glass, of what scatters `albedo` of what it takes.
MaterialDescription boundary(float ior, float roughness, float extinction, float albedo, float g) {
  MaterialDescription material = glass(roughness);
  material.ior = ior;
  material.attenuation_distance = 1;
  material.attenuation_color = Rgb(std::exp(-extinction));
  material.scattering_albedo = Rgb(albedo);
  material.scattering_anisotropy = g;
  return material;
}

double phase(double g, double cosine) {
  return (1 - g * g) / (4 * pi_d * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

double integrate(const std::function<double(double)>& f, double from, double to) {
  return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(f, from, to, 12, 1e-9);
}

PunctualLightDescription point_lamp(const Vec3f& at, float intensity) {
  PunctualLightDescription lamp;
  lamp.intensity = intensity;
  lamp.to_world.origin = at;
  return lamp;
}

/// A scene of a small black triangle below the origin in a ball of fog.
std::unique_ptr<Scene> foggy(const std::vector<PunctualLightDescription>& lamps, const Fog& fog) {
  SceneBuilder builder;
  builder.add(parallelogram({0, -8, 0}, {0, 0, 1e-3f}, {1e-3f, 0, 0}), diffuse(0));
  for (const auto& lamp : lamps) builder.add(lamp);
  auto scene = std::make_unique<Scene>(builder.description(), SceneOptions{});
  scene->fill_air(fog);
  return scene;
}

// What scatters without absorbing changes nothing where light is the same from everywhere, whatever the
// boundary: a white furnace.
TEST(Media, FurnaceStaysWhite) {
  for (const float ior : {1.f, 1.5f})
    for (const float roughness : {0.f, 0.5f})
      for (const float g : {0.f, 0.8f, -0.5f}) {
        if (ior == 1 && roughness > 0) continue;
        SCOPED_TRACE(testing::Message() << "index " << ior << ", roughness " << roughness << ", g " << g);
        const Scene scene = SceneBuilder()
                                .add(sphere({0, 0, 0}, 1, 12, 24), boundary(ior, roughness, 3, 1, g))
                                .environment([](const Vec3f&) { return 1.f; })
                                .build();
        // Rough glass is compensated to a thousandth (BsdfIntegrals).
        EXPECT_TRUE(sees(scene, *path(deep(400)), ray_through({0.3f, 0.2f, 3}, {0.1f, 0, 0}), 1,
                         roughness > 0 ? 2e-2 : 4e-3));
      }
}

// Also behind a diffuse boundary, that of wax and skin.
TEST(Media, FurnaceStaysWhiteBehindDiffuseTransmission) {
  MaterialDescription wax = boundary(1, 1, 3, 1, 0.3f);
  wax.transmission = 0;
  wax.diffuse_transmission = 1;
  wax.specular = 0;
  const Scene scene = SceneBuilder()
                          .add(sphere({0, 0, 0}, 1, 12, 24), wax)
                          .environment([](const Vec3f&) { return 1.f; })
                          .build();
  EXPECT_TRUE(sees(scene, *path(deep(400)), ray_through({0.3f, 0.2f, 3}, {0.1f, 0, 0}), 1, 1e-2));
}

/// Chandrasekhar's H function of isotropic scattering (1960, "Radiative Transfer", chapter V, eq. 24 in the
/// form that converges for every albedo): 1/H = sqrt(1 - albedo) + albedo/2 int mu' H(mu') / (mu + mu') dmu'.
double h_function(double mu, double albedo) {
  constexpr int n = 400;
  std::vector<double> h(n, 1.);
  const auto at = [&](int i) { return (i + 0.5) / n; };
  const auto inverse = [&](double x) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += at(i) * h[size_t(i)] / (x + at(i)) / n;
    return std::sqrt(1 - albedo) + albedo / 2 * sum;
  };
  for (int round = 0; round < 60; ++round) {
    std::vector<double> next(n);
    for (int i = 0; i < n; ++i) next[size_t(i)] = 1 / inverse(at(i));
    // Half a step: whole ones swing about the solution where nothing is absorbed.
    for (int i = 0; i < n; ++i) h[size_t(i)] = (h[size_t(i)] + next[size_t(i)]) / 2;
  }
  return 1 / inverse(mu);
}

// A body without end below a plane reflects 1 - sqrt(1 - albedo) H(mu) of an even sky (Chandrasekhar 1960,
// sections 38 and 77, by reciprocity).
TEST(Media, HalfSpaceReflectsByChandrasekhar) {
  ASSERT_NEAR(h_function(1, 1), 2.9078, 5e-4);  // as his tables have it
  for (const float albedo : {0.5f, 0.9f, 0.99f})
    for (const float mu : {1.f, 0.3f}) {
      SCOPED_TRACE(testing::Message() << "albedo " << albedo << ", cosine " << mu);
      const Scene scene = SceneBuilder()
                              .add(box({-100, -20, -100}, {100, 0, 100}), boundary(1, 0, 10, albedo, 0))
                              .environment([](const Vec3f&) { return 1.f; })
                              .build();
      const double expected = 1 - std::sqrt(1 - double(albedo)) * h_function(double(mu), double(albedo));
      EXPECT_TRUE(sees(scene, *path(deep()), ray_through({safe_sqrt(1 - mu * mu), mu, 0}, {0, 0, 0}),
                       expected, 1e-2));
    }
}

// The glow around a lamp in thin fog, with so little albedo that light is scattered once at most: near to the
// lamp and far, with a cone, behind and before the eye.
TEST(Media, LampsGlowByQuadrature) {
  const float extinction = 0.3f, albedo = 1e-3f;
  struct Case {
    const char* name;
    Vec3f lamp;
    float g;
    float outer_cone;  ///< 0: a point lamp
  };
  for (const Case& c : {Case{"aside", {0, 0.5f, -3}, 0, 0}, Case{"near", {0, 0.01f, -3}, 0.6f, 0},
                        Case{"behind", {0, 1, 2}, -0.4f, 0}, Case{"spot", {0, 1.2f, -2}, 0.3f, 0.6f}}) {
    SCOPED_TRACE(c.name);
    PunctualLightDescription lamp = point_lamp(c.lamp, 1000);
    const Vec3d axis = normalize(Vec3d(0.2, -1, -0.3));
    if (c.outer_cone > 0) {
      lamp.kind = PunctualLightDescription::Kind::spot;
      lamp.outer_cone = c.outer_cone;
      lamp.inner_cone = c.outer_cone - 1e-3f;
      lamp.to_world.z = -Vec3f(axis);
    }
    const float radius = 10;
    const auto scene = foggy({lamp}, {extinction, Rgb(albedo), c.g, radius});
    const Ray ray = ray_through({0, 0, 0}, {0, 0, -1});
    const Vec3d center(scene->bounds().center());
    const double along = -center.z, aside2 = square(center.x) + square(center.y);
    const double end = along + std::sqrt(square(double(radius)) - aside2);
    const auto glow = [&](double t) {
      const Vec3d from_lamp = Vec3d(0, 0, -t) - Vec3d(c.lamp);
      const double d = length(from_lamp);
      double falloff = 1 / (d * d);
      if (c.outer_cone > 0) {
        const double inside = dot(from_lamp, axis) / d - std::cos(double(c.outer_cone));
        const double width = std::cos(double(lamp.inner_cone)) - std::cos(double(c.outer_cone));
        falloff *= square(std::clamp(inside / width, 0., 1.));
      }
      const double cosine = dot(from_lamp, Vec3d(0, 0, 1)) / d;  // light goes on toward the eye at +z
      return 1000 * double(extinction) * double(albedo) * phase(double(c.g), cosine) * falloff *
             std::exp(-double(extinction) * (t + d));
    };
    double expected = 0;
    for (int i = 0; i < 400; ++i) expected += integrate(glow, end * i / 400, end * (i + 1) / 400);
    EXPECT_TRUE(sees(*scene, *path(deep()), ray, expected, 5e-3));
  }
}

// A sun through a slab of haze onto the eye: light scattered once, in closed form.
TEST(Media, SunlitSlabInClosedForm) {
  const double extinction = 0.8, albedo = 1e-3, depth = 2, g = 0.5;
  PunctualLightDescription sun;
  sun.kind = PunctualLightDescription::Kind::directional;
  sun.intensity = 1000;
  sun.to_world.z = normalize(Vec3f(0.5f, 0.8f, 0.1f));
  const Scene lit = SceneBuilder()
                        .add(box({-50, -float(depth), -50}, {50, 0, 50}),
                             boundary(1, 0, float(extinction), float(albedo), float(g)))
                        .add(sun)
                        .build();
  const Vec3f eye_at = normalize(Vec3f(-0.3f, 0.9f, 0.2f));
  const Vec3d wo(eye_at), wi(sun.to_world.z);
  const double a = 1 / wo.y + 1 / wi.y;
  const double expected = 1000 * albedo * extinction * phase(g, -dot(wo, wi)) / wo.y *
                          (1 - std::exp(-extinction * depth * a)) / (extinction * a);
  EXPECT_TRUE(sees(lit, *path(deep()), ray_through(eye_at, {0, 0, 0}), expected, 5e-3));
}

// Colored media: each channel by itself is what all of them are together.
TEST(Media, ChannelsDoNotDisturbEachOther) {
  MaterialDescription colored = boundary(1, 0, 1, 0.9f, 0.2f);
  colored.attenuation_color = {std::exp(-0.2f), std::exp(-2.f), std::exp(-20.f)};
  colored.scattering_albedo = {0.95f, 0.6f, 0.9f};
  const auto scene_of = [&](const MaterialDescription& material) {
    return SceneBuilder()
        .add(sphere({0, 0, 0}, 1, 12, 24), material)
        .environment([](const Vec3f& w) { return 0.2f + std::max(0.f, w.y); })
        .build();
  };
  const Scene all = scene_of(colored);
  const Ray ray = ray_through({0.3f, 0.5f, 3}, {0.1f, 0, 0});
  const auto integrator = path(deep());
  for (int c = 0; c < 3; ++c) {
    MaterialDescription one = colored;
    one.attenuation_color = Rgb(colored.attenuation_color[c]);
    one.scattering_albedo = Rgb(colored.scattering_albedo[c]);
    const Scene alone = scene_of(one);
    const auto mean_of = [&](const Scene& scene, int channel, uint64_t seed, uint64_t samples) {
      Samples means;
      for (uint32_t set = 0; set < 16; ++set) {
        double sum = 0;
        for (uint32_t i = 0; i < samples; ++i) {
          Sampler sampler(set, i, seed);
          sampler.start_block(0);
          sum += double(integrator->estimate(scene, ray, sampler, {}).radiance[channel]);
        }
        means.add(sum / double(samples));
      }
      return means;
    };
    EXPECT_TRUE(confirmed(1e-3, 4096,
                          [&](uint64_t seed, uint64_t samples) {
                            return welch_p_value(mean_of(all, c, seed, samples),
                                                 mean_of(alone, 0, seed + 7, samples));
                          }))
        << "channel " << c;
  }
}

// Fog ends where its ball does, and the sky shines through.
TEST(Media, FogDimsTheSkyByItsBall) {
  Scene scene = SceneBuilder()
                    .add(parallelogram({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), diffuse(0))
                    .environment([](const Vec3f&) { return 1.f; })
                    .build();
  scene.fill_air({0.2f, Rgb(0, 0, 0), 0, 5});
  const Ray outside = ray_through({0, 3, 40}, {0, 3, 0});
  EXPECT_TRUE(sees(scene, *path(deep()), outside, std::exp(-0.2 * 8), 1e-3));
  const Ray passing = ray_through({0, 6, 40}, {0, 6, 0});
  EXPECT_TRUE(sees(scene, *path(deep()), passing, 1, 1e-3));
  EXPECT_NEAR(transmittance(scene, {outside}).fraction.x, std::exp(-0.2 * 8), 1e-5);
  scene.fill_air({});
  EXPECT_TRUE(sees(scene, *path(deep()), outside, 1, 1e-6));
}

// Fog that scatters all it takes, in a white furnace, with things and glass in it.
TEST(Media, FoggyFurnaceStaysWhite) {
  Scene scene = SceneBuilder()
                    .add(parallelogram({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), diffuse(1))
                    .add(sphere({0, 0.2f, 1}, 0.3f, 12, 24), boundary(1.5f, 0, 4, 1, 0.7f))
                    .environment([](const Vec3f&) { return 1.f; })
                    .build();
  scene.fill_air({0.5f, Rgb(1, 1, 1), 0.6f, 3});
  for (const float x : {0.f, 0.4f, 2.f})
    EXPECT_TRUE(sees(scene, *path(deep(200)), ray_through({x, 0.3f, 4}, {x, 0, 0}), 1, 5e-3));
}

}  // namespace
}  // namespace vernier::test
