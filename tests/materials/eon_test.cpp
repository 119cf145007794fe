// SPDX-License-Identifier: Apache-2.0
#include "materials/eon.h"

#include <gtest/gtest.h>

#include "materials/glossy.h"
#include "materials/rough_diffuse.h"
#include "tests/materials/bsdf_cases.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"

namespace vernier::test {
namespace {

constexpr float roughnesses[] = {0.05f, 0.3f, 0.7f, 1};

/// As the paper's listing 1 has it, in double and by its own terms.
double listing_1(double color, double roughness, const Vec3f& wo, const Vec3f& wi) {
  const double c1 = 0.5 - 2 / (3 * M_PI), c2 = 2 / 3. - 28 / (15 * M_PI);
  const auto albedo = [&](double mu) {
    const double a = 1 / (1 + c1 * roughness), si = std::sqrt(1 - mu * mu);
    const double g = si * (std::acos(mu) - si * mu) + (2 / 3.) * ((si / mu) * (1 - si * si * si) - si);
    return a + roughness * a / M_PI * g;
  };
  const double mu_i = wi.z, mu_o = wo.z, s = dot(Vec3d(wi), Vec3d(wo)) - mu_i * mu_o;
  const double s_over_t = s > 0 ? s / std::max(mu_i, mu_o) : s, a = 1 / (1 + c1 * roughness);
  const double average = a * (1 + c2 * roughness);
  const double later = color * color * average / (1 - color * (1 - average));
  return color / M_PI * a * (1 + roughness * s_over_t) +
         later / M_PI * (1 - albedo(mu_o)) * (1 - albedo(mu_i)) / (1 - average);
}

TEST(Eon, IsThatOfThePaper) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const float roughness = 0.02f + 0.98f * random.next1(), color = random.next1();
    const Vec3f wo = direction(0.02f + 0.98f * random.next1(), 6 * random.next1());
    const Vec3f wi = direction(0.02f + 0.98f * random.next1(), 6 * random.next1());
    const double expected = listing_1(double(color), double(roughness), wo, wi);
    EXPECT_NEAR(Eon(roughness)(Rgb(color), wo, wi).x * inv_pi, expected, 2e-5 * expected + 1e-6);
  }
}

TEST(Eon, WithoutRoughnessIsLambertian) {
  const Rgb gold(0.95f, 0.77f, 0.34f);
  for (const float roughness : {0.f, 1e-20f, 1e-9f})
    for (const Vec3f& wo : outgoing_directions())
      for (const Vec3f& wi : outgoing_directions())
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(Eon(roughness)(gold, wo, wi)[c], gold[c], 1e-6);
}

/// The integral over all directions that light comes from, by quadrature. Cosines are squares of what is
/// stepped through, since where wo grazes, much depends on small ones.
double scattered(const Eon& shape, float color, const Vec3f& wo) {
  return integrate_square(
             [&](double x, double y) {
               const Vec3f wi = direction(float(x * x), float(2 * M_PI * y));
               return double(shape(Rgb(color), wo, wi).x) * x * x * 4 * x;
             },
             1e-6, 400'000)
      .value;
}

TEST(Eon, AlbedoIsTheIntegral) {
  for (const float roughness : roughnesses)
    for (const float color : {0.2f, 0.9f, 1.f})
      for (const Vec3f& wo : outgoing_directions()) {
        const RoughDiffuse matte{Rgb(color), Eon(roughness)};
        EXPECT_NEAR(scattered(matte.shape, color, wo), double(matte.albedo(wo).x), 2e-5)
            << roughness << " " << color << " at cos " << wo.z;
      }
}

TEST(Eon, WhiteStaysWhite) {
  for (const float roughness : roughnesses)
    for (float cosine = 0; cosine <= 1; cosine += 0.01f)
      EXPECT_NEAR(Eon(roughness).albedo(Rgb(1), cosine).x, 1, 1e-6);
}

TEST(Eon, WeightsOfSamplesAreBounded) {
  Random random(5);
  float largest = 0;
  for (const float cosine : {0.001f, 0.01f, 0.1f, 0.5f, 1.f})
    for (int i = 0; i < 20'000; ++i) {
      const RoughDiffuse matte{Rgb(1), Eon(1)};
      if (const auto sample = matte.sample(direction(cosine, 1), 0, random.next2()))
        largest = std::max(largest, sample->weight.x);
    }
  EXPECT_LT(largest, 6);
}

/// Under a clear layer: what the product of the layer's terms and the body's loses is bounded, and nothing is
/// gained, whatever the layer.
TEST(Eon, LayersGainNothingAndLoseLittle) {
  for (const float f0 : {0.f, 0.04f, 0.3f})
    for (const float width : {0.f, 0.09f, 1.f})
      for (const float roughness : {0.3f, 1.f})
        for (const Vec3f& wo : outgoing_directions()) {
          DiffuseBase body{Rgb(1)};
          body.roughness = roughness;
          const Glossy plastic = Glossy::coated_diffuse({Rgb(f0), 1, {}}, {width, width}, body);
          body.roughness = 0;
          const Glossy smooth = Glossy::coated_diffuse({Rgb(f0), 1, {}}, {width, width}, body);
          const auto by_body = [&](const Glossy& glossy) {
            const HemisphereChart chart = HemisphereChart::reflection(wo, 0.3);
            return integrate_square(
                       [&](double x, double y) {
                         double solid_angle;
                         const Vec3f wi(chart.direction(x, y, solid_angle));
                         return double(glossy.diffuse(wo, wi).x) * solid_angle;
                       },
                       1e-5, 200'000)
                .value;
          };
          const double gain = by_body(plastic) - by_body(smooth);
          EXPECT_LE(gain, 1e-4) << f0 << " " << width << " " << roughness << " at cos " << wo.z;
          EXPECT_GE(gain, -0.03 * double(roughness))
              << f0 << " " << width << " " << roughness << " at cos " << wo.z;
        }
}

/// glTF mixes linearly in metallic.
TEST(Eon, MixesWithMetalLinearly) {
  DiffuseBase body{{0.9f, 0.5f, 0.1f}};
  body.roughness = 0.8f;
  const Ggx ggx{0.2f, 0.2f};
  const Glossy plastic = Glossy::coated_diffuse({Rgb(0.04f), 1, {}}, ggx, body);
  const Glossy metal = Glossy::conductor({{0.9f, 0.5f, 0.1f}, 1, {}}, ggx);
  const Glossy mixed = Glossy::mix(plastic, metal, 0.25f);
  for (const Vec3f& wo : outgoing_directions())
    for (const Vec3f& wi : outgoing_directions()) {
      const Rgb expected = plastic.eval(wo, wi).f_cos * 0.75f + metal.eval(wo, wi).f_cos * 0.25f;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mixed.eval(wo, wi).f_cos[c], expected[c], 2e-5f * (1 + expected[c]));
    }
}

}  // namespace
}  // namespace vernier::test
