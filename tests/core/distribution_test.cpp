// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace vernier {
namespace {

constexpr double significance = 1e-4;
const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");

TEST(AliasTable, PicksByWeight) {
  const std::vector<std::vector<float>> cases{
      {1}, {1, 1}, {1, 2, 3, 4}, {1e-6f, 1, 1e6f}, {0, 5, 0, 0.1f, 0}, {3, 0, 0, 0}, {nan, 1, inf, -2, 3}};
  for (const auto& weights : cases) {
    const AliasTable table(weights);
    ASSERT_EQ(table.size(), weights.size());
    double sum = 0;
    std::vector<double> prob;
    for (size_t i = 0; i < weights.size(); ++i) {
      const bool usable = std::isfinite(weights[i]) && weights[i] > 0;
      sum += usable ? weights[i] : 0;
      prob.push_back(table.prob(i));
      EXPECT_EQ(table.prob(i) > 0, usable) << i;
    }
    EXPECT_DOUBLE_EQ(table.sum(), sum);
    EXPECT_NEAR(std::accumulate(prob.begin(), prob.end(), 0.0), 1, 1e-6);
    EXPECT_TRUE(test::confirmed(significance, 100'000, [&](uint64_t seed, uint64_t samples) {
      test::Random random(seed);
      std::vector<double> observed(weights.size()), expected(prob);
      for (uint64_t i = 0; i < samples; ++i) observed[table.sample(random.next1())] += 1;
      for (double& e : expected) e *= double(samples);
      return test::chi_square_p_value(observed, expected);
    }));
  }
}

TEST(AliasTable, NeverPicksZeroWeightAtAnyNumber) {
  std::vector<float> weights(1000);
  for (size_t i = 0; i < weights.size(); i += 3) weights[i] = 1 + float(i % 7);
  const AliasTable table(weights);
  for (int i = 0; i < 1 << 20; ++i) ASSERT_GT(table.prob(table.sample(float(i) * 0x1p-20f)), 0);
  ASSERT_GT(table.prob(table.sample(0x1.fffffep-1f)), 0);
}

// Rounding may leave a bin of zero weight last when the table is built; whether it does depends on the
// weights.
TEST(AliasTable, RoundingNeverGivesZeroWeightABin) {
  test::Random random(1);
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<float> weights(2 + size_t(trial) % 100);
    for (size_t i = 1 + size_t(trial) % 3; i < weights.size(); ++i) weights[i] = random.next1() + 1e-3f;
    const AliasTable table(weights);
    if (table.empty()) continue;
    for (size_t bin = 0; bin < weights.size(); ++bin)
      for (const float place : {0.f, 0.5f, 0.999f})
        ASSERT_GT(table.prob(table.sample((float(bin) + place) / float(weights.size()))), 0) << trial;
  }
}

// A weight far below what a float near 1 can tell apart has its part of the numbers nevertheless.
TEST(AliasTable, GivesVeryUnequalWeightsTheirProbability) {
  for (const float faint : {1e-8f, 1e-12f}) {
    const AliasTable table(std::vector<float>{1, faint});
    EXPECT_FLOAT_EQ(table.prob(1), faint);
    EXPECT_EQ(table.sample(0.25), 0u);
    EXPECT_EQ(table.sample(0.5 + 0.99 * faint), 1u);
    EXPECT_EQ(table.sample(0.5 + 1.01 * faint), 0u);
  }
}

TEST(AliasTable, BadWeightsAreNoPlaceForRounding) {
  for (size_t n = 2; n < 100; ++n) {
    std::vector<float> weights(n, 0.1f);
    weights[0] = nan;
    weights[n / 2] = inf;
    weights[n - 1] = 0.7f;
    const AliasTable table(weights);
    for (size_t i = 0; i < 64 * n; ++i) ASSERT_GT(table.prob(table.sample(double(i) / double(64 * n))), 0);
  }
}

TEST(AliasTable, EmptyWhenNothingCanBePicked) {
  EXPECT_TRUE(AliasTable().empty());
  EXPECT_TRUE(AliasTable(std::vector<float>{}).empty());
  EXPECT_TRUE(AliasTable(std::vector<float>{0, nan, -1, inf}).empty());
}

constexpr int columns = 7, rows = 5;

std::vector<float> uneven_values() {
  std::vector<float> values(columns * rows);
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = i % 4 == 1 ? 0 : float((i * 37) % 11) + (i == 17 ? 300 : 0);
  return values;
}

TEST(Distribution2D, PdfIsTheValueOverTheMean) {
  const auto values = uneven_values();
  const Distribution2D distribution(values, columns, rows);
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
  EXPECT_NEAR(distribution.integral(), mean, 1e-5 * mean);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      EXPECT_NEAR(distribution.pdf({(float(x) + 0.5f) / columns, (float(y) + 0.5f) / rows}),
                  values[size_t(y) * columns + x] / mean, 1e-4);
}

TEST(Distribution2D, SamplesFitThePdf) {
  const auto values = uneven_values();
  const Distribution2D distribution(values, columns, rows);
  constexpr int split = 3;  // each cell in 3 x 3, to see that it is uniform inside
  EXPECT_TRUE(test::confirmed(significance, 200'000, [&](uint64_t seed, uint64_t samples) {
    test::Random random(seed);
    std::vector<double> observed(columns * split * rows * split), expected(observed.size());
    for (uint64_t i = 0; i < samples; ++i) {
      float pdf = 0;
      const Vec2f p = distribution.sample(random.next2(), pdf);
      EXPECT_FLOAT_EQ(pdf, distribution.pdf(p));
      EXPECT_GT(pdf, 0);
      observed[size_t(p.y * rows * split) * columns * split + size_t(p.x * columns * split)] += 1;
    }
    for (size_t i = 0; i < expected.size(); ++i) {
      const size_t x = i % (columns * split) / split, y = i / (columns * split) / split;
      expected[i] =
          double(samples) * values[y * columns + x] / distribution.integral() / double(expected.size());
    }
    return test::chi_square_p_value(observed, expected);
  }));
}

TEST(Distribution2D, InversionKeepsOrder) {
  const Distribution2D distribution(uneven_values(), columns, rows);
  float pdf = 0, last = -1;
  for (int i = 0; i < 10'000; ++i) {
    const float y = distribution.sample({0.5f, float(i) / 10'000}, pdf).y;
    ASSERT_GE(y, last);
    last = y;
  }
}

TEST(Distribution2D, EdgesOfTheSquare) {
  const float last = 0x1.fffffep-1f;
  const Distribution2D distribution(uneven_values(), columns, rows);
  for (const float x : {0.f, last})
    for (const float y : {0.f, last}) {
      float pdf = 0;
      const Vec2f p = distribution.sample({x, y}, pdf);
      EXPECT_GE(p.x, 0);
      EXPECT_LE(p.x, 1);
      EXPECT_GE(p.y, 0);
      EXPECT_LE(p.y, 1);
      EXPECT_GT(pdf, 0);
    }
  EXPECT_GE(distribution.pdf({1, 1}), 0);
}

TEST(Distribution2D, OneBrightCellAmongZeroes) {
  std::vector<float> values(64 * 64);
  values[13 * 64 + 63] = 5;
  const Distribution2D distribution(values, 64, 64);
  test::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    float pdf = 0;
    const Vec2f p = distribution.sample(random.next2(), pdf);
    EXPECT_FLOAT_EQ(pdf, 64 * 64);
    EXPECT_EQ(int(p.x * 64), 63);
    EXPECT_EQ(int(p.y * 64), 13);
  }
}

/// A row of `cells` cells of about 1, one of them `bright`.
std::vector<float> row_with_sun(int cells, int sun, float bright) {
  std::vector<float> values;
  for (int i = 0; i < cells; ++i) values.push_back(i == sun ? bright : 1 + float(i % 5));
  return values;
}

// Beside a cell that has nearly all, each of the others is drawn as often as its density says, and evenly
// within.
TEST(Distribution2D, FaintCellsAreDrawnAsTold) {
  constexpr int cells = 8192, sun = 5000;
  for (const float bright : {1e6f, 1e8f, 1e10f}) {
    const Distribution2D distribution(row_with_sun(cells, sun, bright), cells, 1);
    double begin = 0, told = 0;
    for (int i = 0; i < cells; ++i) {
      const double prob = distribution.pdf({(float(i) + 0.5f) / cells, 0.5f}) / double(cells);
      ASSERT_GT(prob, 0);
      told += prob;
      if (i > sun) continue;  // digits of u are fewer near its end
      for (const double place : {0.02, 0.5, 0.98}) {
        float pdf = 0;
        const Vec2f p = distribution.sample({begin + place * prob, 0.5}, pdf);
        ASSERT_FLOAT_EQ(pdf, float(prob * cells)) << i;
        ASSERT_NEAR(p.x * cells, i + place, 0.01) << i;
      }
      begin += prob;
    }
    EXPECT_NEAR(told, 1, 1e-7);
  }
}

// The density is in proportion to the values to what 32 binary digits of the row can tell.
TEST(Distribution2D, FaintCellsHaveTheDensityOfTheirValue) {
  constexpr int cells = 8192, sun = 5000;
  const auto values = row_with_sun(cells, sun, 1e6f);
  const Distribution2D distribution(values, cells, 1);
  for (int i = 0; i < cells; ++i)
    ASSERT_NEAR(distribution.pdf({(float(i) + 0.5f) / cells, 0.5f}) * distribution.integral(),
                values[size_t(i)], 0.001 * values[size_t(i)]);
}

// One row in a thousand has nearly all.
TEST(Distribution2D, FaintRowsAreDrawnAsTold) {
  constexpr int cells = 1000;
  const Distribution2D distribution(row_with_sun(cells, 300, 1e9f), 1, cells);
  double begin = 0;
  for (int i = 0; i < 300; ++i) {
    const double prob = distribution.pdf({0.5f, (float(i) + 0.5f) / cells}) / double(cells);
    float pdf = 0;
    ASSERT_NEAR(distribution.sample({0.5, begin + 0.5 * prob}, pdf).y * cells, i + 0.5, 0.01);
    begin += prob;
  }
}

TEST(Distribution2D, BadValuesCountAsZero) {
  const Distribution2D distribution(std::vector<float>{nan, -5, inf, 2}, 2, 2);
  EXPECT_FALSE(distribution.empty());
  EXPECT_DOUBLE_EQ(distribution.integral(), 0.5);
  EXPECT_FLOAT_EQ(distribution.pdf({0.75f, 0.75f}), 4);
  EXPECT_EQ(distribution.pdf({0.25f, 0.25f}), 0);
  EXPECT_TRUE(Distribution2D().empty());
  EXPECT_TRUE(Distribution2D(std::vector<float>(4), 2, 2).empty());
}

}  // namespace
}  // namespace vernier
