// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/materials/bsdf_cases.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

// Integrals of every BSDF over the directions it scatters to, by quadrature of eval(), which draws no sample.

namespace vernier::test {
namespace {

struct Scattered {
  double energy = 0;  ///< power out over power in, first channel
  double prob = 0;    ///< integral of the pdf, and probability of delta lobes
  double error = 0;   ///< of the quadrature
};

/// Power is radiance times n^2: what crosses the boundary is weighed by the squared relative index.
Scattered integrate(const BsdfCase& bsdf_case, const Vec3f& wo) {
  Scattered sum;
  const double eta2 = bsdf_case.eta * bsdf_case.eta;
  for (const HemisphereChart& chart : charts(bsdf_case, wo)) {
    const auto part = integrate_square<2>(
        [&](double x, double y) -> std::array<double, 2> {
          double solid_angle;
          const Vec3f wi(chart.direction(x, y, solid_angle));
          const BsdfEval value = bsdf_case.bsdf.eval(wo, wi);
          return {value.f_cos.x * (wi.z < 0 ? eta2 : 1) * solid_angle, value.pdf * solid_angle};
        },
        4e-5, 150'000, 5);
    sum.energy += part.value[0];
    sum.prob += part.value[1];
    sum.error += part.error;
  }
  // Delta lobes, found on a grid in the one number that chooses among lobes.
  constexpr int steps = 1 << 15;
  for (int i = 0; i < steps; ++i) {
    const auto sample = bsdf_case.bsdf.sample(wo, (float(i) + 0.5f) / steps, {0.3f, 0.6f});
    if (!sample || !sample->is_delta()) continue;
    sum.energy += double(sample->weight.x) * sample->eta * sample->eta / steps;
    sum.prob += 1.0 / steps;
  }
  return sum;
}

TEST(BsdfIntegrals, ChartsCoverTheirHemispheres) {
  for (const double width : {1e-4, 0.0025, 0.3})
    for (const Vec3f& wo : outgoing_directions())
      for (const auto& chart :
           {HemisphereChart::reflection(wo, width), HemisphereChart::mirrored(wo, width),
            HemisphereChart::refraction(wo, 1.5, width), HemisphereChart::refraction(wo, 1 / 1.5, width)}) {
        const auto area = integrate_square(
            [&](double x, double y) {
              double solid_angle, back_x, back_y;
              const Vec3d wi = chart.direction(x, y, solid_angle);
              EXPECT_TRUE(chart.contains(wi));
              chart.locate(wi, back_x, back_y);
              EXPECT_NEAR(back_x, x, 1e-6);
              EXPECT_NEAR(back_y, y, 1e-6);
              return solid_angle;
            },
            1e-6, 100'000);
        EXPECT_NEAR(area.value, 2 * std::numbers::pi, 1e-5);
      }
}

// White furnace, with n^2 times as much light inside glass: lossless models return all of it, none returns
// more. And the pdf integrates to the probability that sample() answers: samples below the horizon are
// rejected and not drawn again, so that is less than one where facets reflect into the surface.
TEST(BsdfIntegrals, FurnaceAndAcceptance) {
  constexpr int samples = 20'000;
  for (const BsdfCase& bsdf_case : bsdf_cases())
    for (const Vec3f& wo : outgoing_directions()) {
      SCOPED_TRACE(bsdf_case.name + " at cos " + std::to_string(wo.z));
      const Scattered scattered = integrate(bsdf_case, wo);
      EXPECT_LE(scattered.error, 5e-4);
      if (bsdf_case.lossless)
        EXPECT_NEAR(scattered.energy, 1, bsdf_case.tolerance);
      else
        EXPECT_LE(scattered.energy, 1 + bsdf_case.excess);

      int accepted = 0;
      Random random(7);
      for (int i = 0; i < samples; ++i) {
        const float u = random.next1();
        accepted += bsdf_case.bsdf.sample(wo, u, random.next2()).has_value();
      }
      // With no rejection the pdf has to add to one; else five standard errors of the count.
      const double deviation = std::sqrt(std::max(0., scattered.prob * (1 - scattered.prob)) / samples);
      EXPECT_NEAR(scattered.prob, double(accepted) / samples, 1e-4 + 5 * deviation);
    }
}

}  // namespace
}  // namespace vernier::test
