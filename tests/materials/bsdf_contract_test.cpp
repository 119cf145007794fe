// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "tests/materials/bsdf_cases.h"
#include "tests/support/random.h"

// What materials/bsdf_sample.h promises of each BSDF, direction by direction.

namespace vernier::test {
namespace {

bool is_sound(const Rgb& c) { return is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0; }

Vec3f random_direction(Random& random) {
  const Vec2f u = random.next2();
  const float z = 2 * u.x - 1, r = safe_sqrt(1 - z * z), phi = 2 * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

TEST(BsdfContract, CasesCoverEveryModel) {
  std::set<size_t> indices;
  for (const BsdfCase& bsdf_case : bsdf_cases()) indices.insert(bsdf_case.bsdf.index());
  EXPECT_EQ(indices.size(), std::variant_size_v<Bsdf::variant>);
}

TEST(BsdfContract, SampleAgreesWithEval) {
  for (const BsdfCase& bsdf_case : bsdf_cases())
    for (const Vec3f& wo : outgoing_directions()) {
      SCOPED_TRACE(bsdf_case.name + " at cos " + std::to_string(wo.z));
      Random random(11);
      for (int i = 0; i < 500; ++i) {
        const float u = random.next1();
        const auto sample = bsdf_case.bsdf.sample(wo, u, random.next2());
        if (!sample) continue;
        ASSERT_NEAR(length(sample->wi), 1, 1e-5);
        ASSERT_TRUE(is_sound(sample->weight));
        ASSERT_GT(sample->pdf, 0);
        ASSERT_NEAR(sample->eta, sample->is_transmitted() ? bsdf_case.eta : 1, bsdf_case.spread);
        ASSERT_TRUE(bsdf_case.transmits || !sample->is_transmitted());
        if (sample->is_delta()) continue;
        const BsdfEval value = bsdf_case.bsdf.eval(wo, sample->wi);
        ASSERT_NEAR(sample->pdf, value.pdf, 1e-4f * value.pdf);
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(sample->weight[c] * sample->pdf, value.f_cos[c], 1e-4f * max_component(value.f_cos));
      }
    }
}

// What passes straight on is what sample() makes of it in the mean, which over one number is a sum of steps:
// a fine midpoint rule finds it.
TEST(BsdfContract, StraightIsTheMeanOfSamples) {
  int clear = 0;
  for (const BsdfCase& bsdf_case : bsdf_cases())
    for (const Vec3f& wo : outgoing_directions()) {
      SCOPED_TRACE(bsdf_case.name + " at cos " + std::to_string(wo.z));
      constexpr int steps = 20000;
      Vec3d mean(0, 0, 0);
      for (int i = 0; i < steps; ++i) {
        const auto sample = bsdf_case.bsdf.sample(wo, (float(i) + 0.5f) / steps, {0.3f, 0.6f});
        if (!sample || !sample->is_straight()) continue;
        ASSERT_NEAR(dot(sample->wi, wo), -1, 1e-6f);
        mean += Vec3d(sample->weight) / steps;
      }
      const Rgb straight = bsdf_case.bsdf.straight(wo);
      clear += !is_black(straight);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(mean[c], straight[c], 2e-3 * (1 + straight[c]));
    }
  EXPECT_GT(clear, 10);
}

// So are the delta lobes, each way; of dispersing glass those of one color at a time are known.
TEST(BsdfContract, DeltaLobesAreTheMeanOfSamples) {
  int sharp = 0;
  for (const BsdfCase& bsdf_case : bsdf_cases())
    for (const Vec3f& wo : outgoing_directions()) {
      SCOPED_TRACE(bsdf_case.name + " at cos " + std::to_string(wo.z));
      constexpr int steps = 20000;
      Vec3d reflected(0, 0, 0), transmitted(0, 0, 0);
      for (int i = 0; i < steps; ++i) {
        const auto sample = bsdf_case.bsdf.sample(wo, (float(i) + 0.5f) / steps, {0.3f, 0.6f});
        if (!sample || !sample->is_delta()) continue;
        (sample->is_transmitted() ? transmitted : reflected) += Vec3d(sample->weight) / steps;
        if (bsdf_case.spread == 0 && sample->is_transmitted()) {
          ASSERT_EQ(sample->eta, bsdf_case.bsdf.delta(wo).eta);
        }
      }
      const DeltaLobes lobes = bsdf_case.bsdf.delta(wo);
      sharp += !is_black(lobes.reflected);
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(reflected[c], lobes.reflected[c], 2e-3 * (1 + lobes.reflected[c]));
        if (bsdf_case.spread == 0) {
          ASSERT_NEAR(transmitted[c], lobes.transmitted[c], 2e-3 * (1 + lobes.transmitted[c]));
        }
      }
    }
  EXPECT_GT(sharp, 10);
}

// f(wo, wi) = f(wi, wo); through the boundary n^2-scaled, with the other side's BSDF.
TEST(BsdfContract, Reciprocity) {
  for (const BsdfCase& bsdf_case : bsdf_cases()) {
    if (!bsdf_case.reciprocal) continue;
    SCOPED_TRACE(bsdf_case.name);
    Random random(13);
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
      Vec3f wo = random_direction(random);
      wo.z = std::abs(wo.z);
      // Half the pairs from sample(), so that narrow lobes are met.
      Vec3f wi = random_direction(random);
      if (i % 2) {
        const float u = random.next1();
        const auto sample = bsdf_case.bsdf.sample(wo, u, random.next2());
        if (!sample || sample->is_delta()) continue;
        wi = sample->wi;
      }
      if (std::min(std::abs(wo.z), std::abs(wi.z)) < 1e-3f) continue;
      const bool through = wi.z < 0;
      const Vec3f to = through ? -1.f * wi : wi, from = through ? -1.f * wo : wo;
      const Bsdf& reverse = through ? bsdf_case.reverse : bsdf_case.bsdf;
      const Rgb f = bsdf_case.bsdf.eval(wo, wi).f_cos / std::abs(wi.z);
      Rgb g = reverse.eval(to, from).f_cos / std::abs(wo.z);
      if (through) g /= float(bsdf_case.eta * bsdf_case.eta);
      if (!is_black(f)) ++compared;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(f[c], g[c], 2e-4f * max_component(f) + 1e-6f) << wo << " " << wi;
    }
    const bool all_delta = is_black(bsdf_case.bsdf.eval(direction(0.8f, 0), direction(0.8f, pi)).f_cos);
    EXPECT_EQ(compared > 500, !all_delta);
  }
}

// Directions where formulas divide by little: nothing may be infinite, negative or not a number.
TEST(BsdfContract, ExtremeDirections) {
  std::vector<Vec3f> outgoing, incident;
  for (const float z : {0.f, 1e-30f, 1e-9f, 1e-7f, 2e-7f, 1e-5f, 1e-3f, 0.7f, 1.f})
    for (const float azimuth : {0.f, 0.8f, pi}) {
      outgoing.push_back(direction(z, azimuth));
      incident.push_back(direction(z, azimuth));
      incident.push_back(-1.f * direction(z, azimuth));
    }
  for (const BsdfCase& bsdf_case : bsdf_cases())
    for (const Vec3f& wo : outgoing) {
      SCOPED_TRACE(bsdf_case.name + " at cos " + std::to_string(wo.z));
      ASSERT_TRUE(is_sound(bsdf_case.bsdf.albedo(wo)));
      const SpecularRays rays = bsdf_case.bsdf.specular(wo);
      ASSERT_TRUE(is_sound(rays.reflected) && is_sound(rays.transmitted) && is_finite(rays.refracted));
      for (const Vec3f& wi : incident) {
        const BsdfEval value = bsdf_case.bsdf.eval(wo, wi);
        ASSERT_TRUE(is_sound(value.f_cos)) << value.f_cos << " toward " << wi;
        ASSERT_TRUE(std::isfinite(value.pdf) && value.pdf >= 0) << value.pdf << " toward " << wi;
      }
      for (const float u : {0.f, 0.3f, 0.7f, 0x1.fffffep-1f})
        for (const float x : {0.f, 0.25f, 0.5f, 0x1.fffffep-1f})
          for (const float y : {0.f, 1e-7f, 0.5f, 0x1.fffffep-1f}) {
            const auto sample = bsdf_case.bsdf.sample(wo, u, {x, y});
            if (!sample) continue;
            ASSERT_TRUE(is_sound(sample->weight)) << sample->weight << " of " << u << ", " << x << ", " << y;
            ASSERT_TRUE(is_finite(sample->wi) && std::isfinite(sample->pdf) && sample->pdf > 0);
          }
    }
}

}  // namespace
}  // namespace vernier::test
