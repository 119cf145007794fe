// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "materials/dielectric.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"

namespace vernier::test {
namespace {

float reflectance(float cos_i, float eta) {
  float cos_t;
  return fresnel_dielectric(cos_i, eta, cos_t);
}

// Cosine-weighted mean over the hemisphere.
double mean_reflectance(float eta) {
  return integrate_square([&](double x, double) { return 2 * x * reflectance(float(x), eta); }, 1e-6, 300'000)
      .value;
}

TEST(Fresnel, GlassAtSpecialAngles) {
  EXPECT_NEAR(reflectance(1, 1.5f), 0.04, 1e-6);
  EXPECT_NEAR(reflectance(1, 1 / 1.5f), 0.04, 1e-6);
  EXPECT_NEAR(reflectance(1e-7f, 1.5f), 1, 1e-5);
  EXPECT_NEAR(f0_from_ior(1.5f), 0.04, 1e-6);
  EXPECT_EQ(reflectance(0.5f, 1), 0);

  // At Brewster's angle, atan 1.5 = 56.3099 degrees, only perpendicular polarisation is reflected:
  // half of ((n^2 - 1) / (n^2 + 1))^2.
  const float brewster = 56.3099f * pi / 180;
  const double n2 = 1.5 * 1.5, expected = std::pow((n2 - 1) / (n2 + 1), 2) / 2;
  EXPECT_NEAR(reflectance(std::cos(brewster), 1.5f), expected, 1e-6);

  // Total internal reflection begins at asin(1 / 1.5) = 41.8103 degrees.
  const float critical = 41.8103f * pi / 180;
  EXPECT_EQ(reflectance(std::cos(critical + 1e-4f), 1 / 1.5f), 1);
  EXPECT_LT(reflectance(std::cos(critical - 1e-4f), 1 / 1.5f), 0.95f);
}

TEST(Fresnel, HemisphericalMeans) {
  EXPECT_NEAR(mean_reflectance(1.5f), 0.091778, 2e-5);
  EXPECT_NEAR(mean_reflectance(1 / 1.5f), 0.596345, 2e-5);
}

TEST(Fresnel, Schlick) {
  const Rgb f0(0.04f, 0.5f, 1), f90(1, 1, 0.5f);
  EXPECT_EQ(fresnel_schlick(f0, f90, 1), f0);
  EXPECT_EQ(fresnel_schlick(f0, f90, 0), f90);
  EXPECT_NEAR(fresnel_schlick(f0, f90, 0.5f).x, 0.04 + 0.96 / 32, 1e-6);
  EXPECT_EQ(schlick_weight(1.0000001f), 0);
}

/// A smooth boundary of index eta: the sampled reflection or refraction of wo.
BsdfSample cross(float eta, const Vec3f& wo, bool transmitted) {
  const auto sample = Dielectric{eta, Ggx{0, 0}}.sample(wo, transmitted ? 0x1.fffffep-1f : 0, {0.5f, 0.5f});
  EXPECT_TRUE(sample && sample->is_delta() && sample->is_transmitted() == transmitted);
  return *sample;
}

TEST(Dielectric, ObeysSnell) {
  Random random(3);
  for (const float eta : {1.1f, 1.5f, 2.4f, 1 / 1.1f, 1 / 1.5f})
    for (int i = 0; i < 1000; ++i) {
      const float z = 1 - random.next1(), phi = 2 * pi * random.next1(), r = safe_sqrt(1 - z * z);
      if (r >= 0.999f * eta) continue;
      const Vec3f wo(r * std::cos(phi), r * std::sin(phi), z);
      const BsdfSample sample = cross(eta, wo, true);
      EXPECT_NEAR(length(sample.wi), 1, 1e-6);
      // Tangential components: n_o sin_o = n_i sin_i in the plane of incidence.
      EXPECT_NEAR(wo.x + eta * sample.wi.x, 0, 1e-6 * std::max(1.f, eta));
      EXPECT_NEAR(wo.y + eta * sample.wi.y, 0, 1e-6 * std::max(1.f, eta));
      EXPECT_EQ(sample.eta, eta);
    }
}

// Radiance through a plane-parallel slab: all orders of reflection inside summed, (1 - F)^2 tau / (1 - F^2
// tau^2) with tau = exp(-sigma d / cos_t).
TEST(Dielectric, SlabTransmits) {
  const float n = 1.5f;
  for (const float depth : {0.f, 0.3f, 2.f})  // optical depth sigma d
    for (const float cosine : {1.f, 0.7f, 0.2f}) {
      const Vec3f wo(safe_sqrt(1 - cosine * cosine), 0, cosine);
      const BsdfSample enter = cross(n, wo, true);
      const float tau = std::exp(-depth / -enter.wi.z);
      double carried = enter.weight.x * enter.pdf, seen = 0;
      for (int order = 0; order < 60; ++order) {
        carried *= tau;
        const Vec3f inside(-enter.wi.x, -enter.wi.y, -enter.wi.z);  // toward where the light comes from
        const BsdfSample leave = cross(1 / n, inside, true), stay = cross(1 / n, inside, false);
        if (order % 2 == 0) seen += carried * leave.weight.x * leave.pdf;
        carried *= stay.weight.x * stay.pdf;
      }
      const double f = reflectance(cosine, n);
      EXPECT_NEAR(seen, (1 - f) * (1 - f) * tau / (1 - f * f * tau * tau), 1e-6);
      if (depth == 0 && cosine == 1) {
        EXPECT_NEAR(seen, 2 * n / (n * n + 1), 1e-6);
      }
    }
}

}  // namespace
}  // namespace vernier::test
