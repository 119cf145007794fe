// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/tables/ggx_energy.h"
#include "tests/materials/bsdf_cases.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"

namespace vernier::test {
namespace {

/// Facet normals on the unit square, polar about n with tan = alpha r / (1 - r), and their solid angle.
Vec3d facet(const Ggx& ggx, double x, double y, double& solid_angle) {
  const double r = x / (1 - x), phi = 2 * std::numbers::pi * y;
  const Vec3d slope(ggx.ax * r * std::cos(phi), ggx.ay * r * std::sin(phi), 1);
  const double l2 = dot(slope, slope);
  solid_angle = 2 * std::numbers::pi * r * ggx.ax * ggx.ay / ((1 - x) * (1 - x) * l2 * std::sqrt(l2));
  return slope / std::sqrt(l2);
}

/// Lambda and G2 in double, from their definitions (Heitz 2014).
double lambda(const Ggx& ggx, const Vec3d& w) {
  const double tan2 = (ggx.ax * w.x * ggx.ax * w.x + ggx.ay * w.y * ggx.ay * w.y) / (w.z * w.z);
  return (std::sqrt(1 + tan2) - 1) / 2;
}

const std::vector<Ggx> widths{{0.0025f, 0.0025f}, {0.01f, 0.01f}, {0.09f, 0.09f}, {0.3f, 0.3f},
                              {0.5f, 0.5f},       {1, 1},         {0.3f, 0.05f},  {0.0025f, 0.09f}};

// Facets project to the plane: integral of D(m) m.z is 1. Visible ones too, seen from any direction: the weak
// furnace.
TEST(Ggx, DistributionsIntegrateToOne) {
  for (const Ggx& ggx : widths) {
    const auto projected = integrate_square(
        [&](double x, double y) {
          double solid_angle;
          const Vec3d m = facet(ggx, x, y, solid_angle);
          return ggx.d(Vec3f(m)) * m.z * solid_angle;
        },
        1e-5);
    EXPECT_NEAR(projected.value, 1, 1e-4);
    for (const Vec3f& wo : outgoing_directions()) {
      const auto visible = integrate_square(
          [&](double x, double y) {
            double solid_angle;
            const Vec3d m = facet(ggx, x, y, solid_angle);
            return ggx.visible_pdf(wo, Vec3f(m)) * solid_angle;
          },
          2e-5);
      EXPECT_NEAR(visible.value, 1, 1e-4) << ggx.ax << ' ' << ggx.ay << " at cos " << wo.z;
    }
  }
}

// The mean of the sampled normals is that of the density: catches a wrong axis or a lost sign where a
// goodness-of-fit test over symmetric cells might not.
TEST(Ggx, SampledNormalsHaveTheMeanOfTheirDensity) {
  for (const Ggx& ggx : widths)
    for (const Vec3f& wo : outgoing_directions()) {
      const auto expected = integrate_square<3>(
          [&](double x, double y) -> std::array<double, 3> {
            double solid_angle;
            const Vec3d m = facet(ggx, x, y, solid_angle);
            const double p = ggx.visible_pdf(wo, Vec3f(m)) * solid_angle;
            return {m.x * p, m.y * p, m.z * p};
          },
          2e-5);
      Vec3d sum(0, 0, 0);
      constexpr int grid = 256;
      for (int i = 0; i < grid * grid; ++i) {
        const int row = i / grid;
        const Vec2f u((float(i % grid) + 0.5f) / grid, (float(row) + 0.5f) / grid);
        const Vec3f m = ggx.sample_visible(wo, u);
        ASSERT_GE(m.z, 0);
        ASSERT_GE(dot(wo, m), -1e-6f);
        sum += Vec3d(m) / double(grid * grid);
      }
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c], expected.value[c], 1e-3) << ggx.ax << " at cos " << wo.z;
    }
}

TEST(Ggx, VisibleNormalsStayFiniteAtGrazing) {
  for (const float a : {5e-4f, 0.0025f, 0.3f, 1.f})
    for (const float z : {1e-7f, 1e-6f, 1e-4f, 1.f})
      for (const float x : {0.f, 0.25f, 0.5f, 0x1.fffffep-1f})
        for (const float y : {0.f, 0x1p-24f, 0.5f, 0x1.fffffep-1f}) {
          const Vec3f wo = direction(z, 0.3f);
          const Vec3f m = Ggx{a, a}.sample_visible(wo, {x, y});
          EXPECT_NEAR(length(m), 1, 1e-5);
          EXPECT_GE(m.z, 0);
        }
}

/// Albedo of reflection with reflectance 1, and with Schlick's grazing term alone.
std::array<double, 2> albedo(const Ggx& ggx, const Vec3f& wo) {
  const HemisphereChart chart = HemisphereChart::reflection(wo, 0.3 * std::min(ggx.ax, ggx.ay));
  const Vec3d o = normalize(Vec3d(wo));
  return integrate_square<2>(
             [&](double x, double y) -> std::array<double, 2> {
               double solid_angle;
               const Vec3d wi = chart.direction(x, y, solid_angle);
               const Vec3d m = normalize(o + wi);
               const double s =
                   m.x * m.x / (double(ggx.ax) * ggx.ax) + m.y * m.y / (double(ggx.ay) * ggx.ay) + m.z * m.z;
               const double d = 1 / (std::numbers::pi * ggx.ax * ggx.ay * s * s);
               const double value = d / (4 * o.z * (1 + lambda(ggx, o) + lambda(ggx, wi))) * solid_angle;
               return {value, value * std::pow(1 - dot(o, m), 5)};
             },
             2e-5, 200'000, 12)
      .value;
}

TEST(GgxEnergy, TableAgreesWithQuadrature) {
  for (const float alpha : {6e-4f, 0.0025f, 0.006f, 0.02f, 0.05f, 0.09f, 0.2f, 0.4f, 0.77f, 1.f})
    for (const float cosine : {1e-3f, 0.004f, 0.01f, 0.03f, 0.07f, 0.2f, 0.5f, 0.85f, 1.f}) {
      const auto [total, grazing] = albedo({alpha, alpha}, direction(cosine, 0));
      const GgxAlbedo table = ggx_albedo(cosine, alpha);
      EXPECT_NEAR(1 - table.energy_loss, total, 7e-4) << alpha << " at cos " << cosine;
      EXPECT_NEAR(table.schlick_bias, grazing, 1e-3) << alpha << " at cos " << cosine;
    }
}

TEST(GgxEnergy, AnisotropicTablesAgreeWithQuadrature) {
  for (const Ggx& ggx : {Ggx{0.3f, 0.05f}, Ggx{0.05f, 0.3f}, Ggx{0.0025f, 0.09f}, Ggx{1, 0.3f},
                         Ggx{0.7f, 0.5f}, Ggx{1, 0.05f}, Ggx{0.2f, 0.19f}})
    for (const float cosine : {0.01f, 0.03f, 0.1f, 0.3f, 0.7f, 1.f})
      for (const float azimuth : {0.f, 0.5f, 1.2f, 1.55f, 2.5f, -0.8f}) {
        const double tolerance = ggx.ax == 1 && ggx.ay < 0.1f ? 1e-2 : 5e-3;
        const Vec3f wo = direction(cosine, azimuth);
        const auto [total, grazing] = albedo(ggx, wo);
        const GgxAlbedo table = ggx_albedo(wo, ggx);
        EXPECT_NEAR(1 - table.energy_loss, total, tolerance)
            << ggx.ax << ' ' << ggx.ay << ' ' << cosine << ' ' << azimuth;
        EXPECT_NEAR(table.schlick_bias, grazing, tolerance)
            << ggx.ax << ' ' << ggx.ay << ' ' << cosine << ' ' << azimuth;
      }
}

TEST(GgxEnergy, KnownValues) {
  EXPECT_NEAR(1 - ggx_albedo(1, 1).energy_loss, 1 - std::log(2.), 5e-4);  // in closed form
  const std::pair<float, double> means[] = {{0.1f, 0.972}, {0.25f, 0.882}, {0.5f, 0.700}, {1, 0.409}};
  for (const auto& [alpha, mean] : means) EXPECT_NEAR(1 - ggx_average_albedo(alpha).energy_loss, mean, 1e-3);
  EXPECT_NEAR(ggx_average_albedo(5e-4f).schlick_bias, 1 / 21., 5e-4);  // mean of Schlick's weight
}

// The mean is that of what lookups give, whatever lies between nodes.
TEST(GgxEnergy, MeanIsThatOfTheTable) {
  for (const float alpha : {6e-4f, 0.0025f, 0.0031f, 0.03f, 0.2f, 0.6f, 1.f}) {
    double missing = 0, bias = 0;
    constexpr int steps = 20'000;
    for (int i = 0; i < steps; ++i) {
      const double x = (i + 0.5) / steps, weight = 4 * x * x * x / steps;  // 2 mu dmu with mu = x^2
      const GgxAlbedo at = ggx_albedo(float(x * x), alpha);
      missing += weight * at.energy_loss;
      bias += weight * at.schlick_bias;
    }
    // A tenth at most is missing toward any direction where the error of the mean is this large.
    EXPECT_NEAR(ggx_average_albedo(alpha).energy_loss / missing, 1, 9e-3) << alpha;
    EXPECT_NEAR(ggx_average_albedo(alpha).schlick_bias, bias, 3e-4) << alpha;
  }
}

}  // namespace
}  // namespace vernier::test
