// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "tests/materials/bsdf_cases.h"
#include "tests/support/effort.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace vernier::test {
namespace {

// Cells of a chart: 20 in the logarithm of the angle from the lobe's centre, 12 in azimuth.
constexpr int columns = 20, rows = 12;

/// Expected fraction of samples in each cell of all charts, then that of samples rejected or from delta
/// lobes.
std::vector<double> expected_fractions(const BsdfCase& bsdf_case, const Vec3f& wo) {
  std::vector<double> fractions;
  double sum = 0;
  for (const HemisphereChart& chart : charts(bsdf_case, wo))
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const auto cell = integrate_square(
            [&](double x, double y) {
              double solid_angle;
              const Vec3f wi(chart.direction((i + x) / columns, (j + y) / rows, solid_angle));
              return bsdf_case.bsdf.eval(wo, wi).pdf * solid_angle / (columns * rows);
            },
            1e-6, 20'000, 1);
        fractions.push_back(cell.value);
        sum += cell.value;
      }
  fractions.push_back(std::max(0., 1 - sum));
  return fractions;
}

std::vector<double> count_samples(const BsdfCase& bsdf_case, const Vec3f& wo, uint64_t seed,
                                  uint64_t samples) {
  const auto all_charts = charts(bsdf_case, wo);
  std::vector<double> counts(all_charts.size() * columns * rows + 1);
  Random random(seed);
  for (uint64_t s = 0; s < samples; ++s) {
    const float u = random.next1();
    const auto sample = bsdf_case.bsdf.sample(wo, u, random.next2());
    size_t cell = counts.size() - 1;
    for (size_t c = 0; sample && !sample->is_delta() && c < all_charts.size(); ++c) {
      if (!all_charts[c].contains(Vec3d(sample->wi))) continue;
      double x, y;
      all_charts[c].locate(Vec3d(sample->wi), x, y);
      const int i = std::clamp(int(x * columns), 0, columns - 1), j = std::clamp(int(y * rows), 0, rows - 1);
      cell = (c * rows + size_t(j)) * columns + size_t(i);
    }
    ++counts[cell];
  }
  return counts;
}

// 10^6 samples of each BSDF in all against the integral of its pdf over each cell; family-wise significance
// 0.01. Of a cell with a hundredth of the samples a deviation of some 10 % shows, of the whole distribution
// one of 1 %.
TEST(BsdfChiSquare, SamplesFollowPdf) {
  const auto cases = bsdf_cases();
  const auto directions = outgoing_directions();
  const double significance = sidak(0.01, cases.size() * directions.size());
  const uint64_t samples = 1'000'000 / thinning / directions.size();
  const auto follows = [&](const BsdfCase& bsdf_case, const Vec3f& wo) {
    const std::vector<double> fractions = expected_fractions(bsdf_case, wo);
    return confirmed(significance, samples, [&](uint64_t seed, uint64_t count) {
      std::vector<double> expected = fractions;
      for (double& e : expected) e *= double(count);
      return chi_square_p_value(count_samples(bsdf_case, wo, seed, count), expected);
    });
  };
  std::vector<std::vector<int>> passed(cases.size());
  parallel_for(cases.size(), [&](size_t i) {
    for (const Vec3f& wo : directions) passed[i].push_back(follows(cases[i], wo));
  });
  for (size_t i = 0; i < cases.size(); ++i)
    for (size_t k = 0; k < directions.size(); ++k)
      EXPECT_TRUE(passed[i][k]) << cases[i].name << " at cos " << directions[k].z;
}

}  // namespace
}  // namespace vernier::test
