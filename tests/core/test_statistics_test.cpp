// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "tests/support/quadrature.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

// The tests' own tools.

namespace vernier::test {
namespace {

Samples uniform_samples(uint64_t seed, int count, double shift) {
  Samples samples;
  Random random(seed);
  for (int i = 0; i < count; ++i) samples.add(random.next1() + shift);
  return samples;
}

TEST(TestStatistics, MeanAndVariance) {
  Samples samples;
  for (const double x : {1., 2., 3., 4., 10.}) samples.add(x);
  EXPECT_DOUBLE_EQ(samples.mean(), 4);
  EXPECT_DOUBLE_EQ(samples.variance(), 12.5);
  EXPECT_DOUBLE_EQ(samples.standard_error(), std::sqrt(2.5));
}

// Student's own table: t = 2.776 at 4 degrees of freedom is two-sided 0.05.
TEST(TestStatistics, MeanPValue) {
  Samples samples;
  for (const double x : {1., 2., 3., 4., 10.}) samples.add(x);
  EXPECT_NEAR(mean_p_value(samples, 4 - 2.776445 * std::sqrt(2.5)), 0.05, 1e-4);
  EXPECT_DOUBLE_EQ(mean_p_value(samples, 4), 1);
}

TEST(TestStatistics, WelchSeesABiasOfItsDetectableSize) {
  const Samples a = uniform_samples(1, 100'000, 0), b = uniform_samples(2, 100'000, 0);
  EXPECT_GT(welch_p_value(a, b), 1e-3);
  const double error = std::sqrt(2.) * a.standard_error(), bias = detectable_bias(error, 1e-3);
  EXPECT_NEAR(bias, (3.2905 + 1.2816) * error, 1e-3 * error);
  int found = 0;
  for (uint64_t seed = 10; seed < 60; ++seed)
    found += welch_p_value(uniform_samples(seed, 10'000, 0),
                           uniform_samples(seed + 1000, 10'000, bias * std::sqrt(10.))) < 1e-3;
  EXPECT_GE(found, 40);  // nine in ten are expected
}

// p-values of true hypotheses are uniform: their mean is one half.
TEST(TestStatistics, ChiSquareIsCalibrated) {
  Samples p_values;
  const std::array<double, 6> fractions{0.3, 0.3, 0.3, 0.0999, 0.0001, 0};
  for (uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed);
    std::array<double, 6> observed{}, expected{};
    constexpr int count = 5000;
    for (int i = 0; i < count; ++i) {
      const float u = random.next1();
      ++observed[u < 0.3f ? 0 : u < 0.6f ? 1 : u < 0.9f ? 2 : u < 0.9999f ? 3 : 4];
    }
    for (size_t k = 0; k < 6; ++k) expected[k] = fractions[k] * count;
    p_values.add(chi_square_p_value(observed, expected));
  }
  EXPECT_NEAR(p_values.mean(), 0.5, 0.06);
  EXPECT_NEAR(p_values.variance(), 1 / 12., 0.02);
}

TEST(TestStatistics, ChiSquareSeesWhatIsWrong) {
  const std::array<double, 3> expected{100, 100, 100}, skewed{150, 75, 75};
  EXPECT_LT(chi_square_p_value(skewed, expected), 1e-6);
  const std::array<double, 3> nowhere{200, 100, 0}, there{200, 80, 20};
  EXPECT_LT(chi_square_p_value(there, nowhere), 1e-3);
}

TEST(TestStatistics, Sidak) { EXPECT_NEAR(1 - std::pow(1 - sidak(0.01, 50), 50), 0.01, 1e-12); }

TEST(TestStatistics, ConfirmedRunsOnceMore) {
  int runs = 0;
  EXPECT_TRUE(confirmed(0.01, 10, [&](uint64_t, uint64_t) { return ++runs, 0.5; }));
  EXPECT_EQ(runs, 1);
  uint64_t last_samples = 0;
  EXPECT_FALSE(confirmed(0.01, 10, [&](uint64_t, uint64_t samples) {
    last_samples = samples;
    return ++runs, 0.001;
  }));
  EXPECT_EQ(runs, 3);
  EXPECT_EQ(last_samples, 160u);
}

TEST(TestQuadrature, FindsANarrowPeak) {
  const double width = 1e-3;
  const auto integral = integrate_square<2>(
      [&](double x, double y) -> std::array<double, 2> {
        const double r2 = (x - 0.31) * (x - 0.31) + (y - 0.62) * (y - 0.62);
        return {std::exp(-r2 / (width * width)) + 1e-9, x * y};
      },
      1e-11, 400'000, 128);
  EXPECT_NEAR(integral.value[0], std::numbers::pi * width * width, 1e-8);
  EXPECT_NEAR(integral.value[1], 0.25, 1e-9);
}

}  // namespace
}  // namespace vernier::test
