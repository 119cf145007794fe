// SPDX-License-Identifier: Apache-2.0
#include "core/compare/bias_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/parallel.h"
#include "vernier/error.h"

namespace vernier {
namespace {

constexpr int size = 48;

struct Render {
  Image mean{size, size, 3}, error{size, size, 3};
};

// Expectation of the picture: a gradient, darker below.
double expectation(int x, int y, int c) {
  return (0.2 + double(x) / size) * (1.5 - double(y) / size) * (c + 1);
}

// A picture whose values are means of `groups` normal group means; `bias(x, y)` is added in standard
// deviations of a pixel's mean.
template <typename Bias>
Render render(uint64_t seed, int groups, const Bias& bias) {
  Render result;
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      for (int c = 0; c < 3; ++c) {
        const double mean = expectation(x, y, c), deviation = 0.3 * mean;  // of one group
        double sum = 0, squares = 0;
        for (int g = 0; g < groups; ++g) {
          const double value = normal(engine) * deviation;
          sum += value;
          squares += value * value;
        }
        const double variance = (squares - sum * sum / groups) / (groups - 1);
        const double error = deviation / std::sqrt(double(groups));
        result.mean.pixel(x, y)[c] = float(mean + sum / groups + bias(x, y) * error);
        result.error.pixel(x, y)[c] = float(std::sqrt(variance / groups));
      }
  return result;
}

constexpr auto unbiased = [](int, int) { return 0.0; };

BiasTest test(const Render& a, const Render& b, double degrees, double level = 0.01) {
  return test_bias({a.mean, a.error, degrees}, {b.mean, b.error, degrees}, level);
}

// At level 0.05 two unbiased pictures are called different at most once in ten. Of 100 trials with
// probability 0.1, more than 22 fail with probability 1e-4.
TEST(BiasTest, UnbiasedPicturesSeldomDiffer) {
  for (const int groups : {4, 16}) {
    int different = 0;
    for (uint64_t seed = 0; seed < 100; ++seed)
      different += test(render(2 * seed + 1, groups, unbiased), render(2 * seed + 2, groups, unbiased),
                        groups - 1, 0.05)
                       .different();
    EXPECT_LE(different, 22) << groups << " groups";
    EXPECT_GE(different, 1) << "a test that never fires is too timid: probability below 1e-2 at 0.05";
  }
}

// The errors' own uncertainty matters: as if they were exact, four groups would give false findings
// everywhere.
TEST(BiasTest, DegreesOfFreedomMatter) {
  const Render a = render(1, 4, unbiased), b = render(2, 4, unbiased);
  EXPECT_EQ(test(a, b, 3).differing, 0);
  EXPECT_GT(test(a, b, std::numeric_limits<double>::infinity()).differing, 10);
}

TEST(BiasTest, FindsABlockAndLittleElse) {
  const auto in_block = [](int x, int y) { return x >= 30 && x < 42 && y >= 10 && y < 22; };
  const Render a = render(1, 16, unbiased);
  const Render b = render(2, 16, [&](int x, int y) { return in_block(x, y) ? 12.0 : 0.0; });
  const BiasTest result = test(a, b, 15);
  EXPECT_TRUE(result.different());
  EXPECT_GE(result.differing, 130);
  EXPECT_LE(result.differing, 144 * 1.05);
  EXPECT_TRUE(in_block(result.worst_x, result.worst_y));
  EXPECT_LT(result.smallest_p, 1e-6);
  EXPECT_EQ(result.tested, size * size);
}

TEST(BiasTest, FindsAFaintBiasOfTheWholePicture) {
  // A fifth of a pixel's error, which no pixel shows, is twenty errors of the mean of 96 x 96 (the difference
  // has sqrt 2 of them).
  const Render a = render(1, 16, unbiased), b = render(2, 16, [](int, int) { return 0.25; });
  const BiasTest result = test(a, b, 15);
  EXPECT_EQ(result.differing, 0);
  EXPECT_LT(result.mean_p, 1e-6);
  EXPECT_TRUE(result.different());
  for (int c = 0; c < 3; ++c) EXPECT_LT(result.mean_difference[size_t(c)], 0);
}

TEST(BiasTest, MeanAndItsErrorByHand) {
  Image x(2, 1, 3), y(2, 1, 3), ex(2, 1, 3), ey(2, 1, 3);
  x.values = {1, 1, 1, 3, 1, 1};
  y.values = {0, 1, 1, 1, 1, 1};
  ex.values = {3, 3, 3, 4, 3, 3};
  ey.values = {0, 0, 0, 12, 0, 0};
  const BiasTest result = test_bias({x, ex}, {y, ey});
  EXPECT_NEAR(result.mean_difference[0], 1.5, 1e-6);
  EXPECT_EQ(result.mean_difference[1], 0);
  EXPECT_NEAR(result.mean_error[0], std::sqrt(9 + 16 + 144) / 2, 1e-9);
  // Pixel 0: z = 1/3, pixel 1: z = 2 / sqrt 160; the first has the smaller p.
  EXPECT_NEAR(result.smallest_p, 1 - std::pow(1 - std::erfc(1 / 3.0 / std::sqrt(2.0)), 3), 1e-6);
  EXPECT_EQ(result.worst_x, 0);
}

TEST(BiasTest, ErrorsThatGoTogetherAddUp) {
  Image x(2, 1, 3), y(2, 1, 3), ex(2, 1, 3), ey(2, 1, 3);
  x.values = {1, 1, 1, 3, 1, 1};
  y.values = {0, 1, 1, 1, 1, 1};
  ex.values = {3, 3, 3, 4, 3, 3};
  ey.values = {0, 0, 0, 12, 0, 0};
  MeasuredImage filtered{x, ex};
  filtered.errs_together = true;
  const double error = std::sqrt(7.0 * 7 + 12 * 12);
  EXPECT_NEAR(test_bias(filtered, {y, ey}).mean_error[0], error / 2, 1e-9);
  // As one block: the sums differ by 3.
  EXPECT_NEAR(test_bias(filtered, {y, ey}, 0.01, 2).smallest_p,
              1 - std::pow(1 - std::erfc(3 / error / std::sqrt(2.0)), 3), 1e-6);
}

TEST(BiasTest, ExactValues) {
  Render a, b;
  std::fill(a.mean.values.begin(), a.mean.values.end(), 0.1f);
  b.mean = a.mean;
  EXPECT_FALSE(test(a, b, 15).different()) << "equal values without error";
  b.mean.values[300] = std::nextafter(0.1f, 1.f);
  EXPECT_FALSE(test(a, b, 15).different()) << "a rounding apart";
  b.mean.values[300] = 0.1001f;
  EXPECT_EQ(test(a, b, 15).differing, 1);
  EXPECT_EQ(test(a, b, 15).smallest_p, 0);
}

TEST(BiasTest, NotFinitePixelsAreLeftOut) {
  Render a, b;
  a.mean.values[0] = NAN;
  b.error.values[10] = INFINITY;
  const BiasTest result = test(a, b, 15);
  EXPECT_EQ(result.not_finite, 2);
  EXPECT_EQ(result.tested, size * size - 2);
  EXPECT_FALSE(result.different());
}

TEST(BiasTest, OneThreadGivesTheSameBits) {
  const Render a = render(1, 16, unbiased), b = render(2, 16, unbiased);
  const BiasTest many = test(a, b, 15);
  const ThreadLimit one(1);
  const BiasTest single = test(a, b, 15);
  EXPECT_EQ(single.mean_p, many.mean_p);
  EXPECT_EQ(single.mean_difference, many.mean_difference);
}

TEST(BiasTest, SizesMustAgree) {
  const Image a(2, 2, 3), b(3, 2, 3);
  EXPECT_THROW(test_bias({a, a}, {b, b}), Error);
  EXPECT_THROW(test_bias({a, Image(2, 2, 1)}, {a, a}), Error);
}

// Less than a standard deviation in each pixel is lost among pixels and found in blocks of 64.
TEST(BiasTest, BlocksFindWhatIsFaintAndWide) {
  const auto in_corner = [](int x, int y) { return x < 24 && y < 24 ? 0.7 : 0.0; };
  const Render a = render(1, 16, unbiased), b = render(2, 16, in_corner);
  EXPECT_EQ(test(a, b, 15).differing, 0);
  const BiasTest blocks = test_bias({a.mean, a.error, 15}, {b.mean, b.error, 15}, 0.01, 8);
  EXPECT_EQ(blocks.tested, 36);
  EXPECT_GE(blocks.differing, 5);
  EXPECT_LE(blocks.differing, 9);
  EXPECT_TRUE(blocks.worst_x < 24 && blocks.worst_y < 24);
}

// Pixels whose error is too small, and known to be.
TEST(BiasTest, UnreliablePixelsAreLeftOut) {
  const Render a = render(1, 16, unbiased);
  Render b = render(2, 16, [](int x, int y) { return x == 5 && y == 7 ? 50.0 : 0.0; });
  Image flags(size, size, 1);
  *flags.pixel(5, 7) = 1;
  EXPECT_EQ(test(a, b, 15).differing, 1);
  const BiasTest result = test_bias({a.mean, a.error, 15}, {b.mean, b.error, 15, &flags});
  EXPECT_EQ(result.differing, 0);
  EXPECT_EQ(result.unreliable, 1);
  EXPECT_EQ(result.tested, size * size - 1);
  const Image wrong(size, 1, 1);
  EXPECT_THROW(test_bias({a.mean, a.error, 15, &wrong}, {b.mean, b.error, 15}), Error);
}

}  // namespace
}  // namespace vernier
