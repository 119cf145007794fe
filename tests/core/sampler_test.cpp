// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/sampler.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/statistics.h"

namespace vernier {
namespace {

constexpr int dimensions = 8;
constexpr double significance = 1e-4;

// All numbers of one block of one sample.
std::array<float, dimensions> draw(uint32_t stream, uint32_t index, uint64_t seed, uint32_t block) {
  Sampler sampler(stream, index, seed);
  sampler.start_block(block);
  std::array<float, dimensions> numbers;
  for (float& number : numbers) number = sampler.next1();
  return numbers;
}

// p-value of uniformity of the pairs that `pair` makes of a number i, on an n x n grid.
template <typename Pair>
double uniformity(uint64_t samples, const Pair& pair) {
  constexpr int n = 16;
  std::vector<double> observed(n * n), expected(n * n, double(samples) / (n * n));
  for (uint64_t i = 0; i < samples; ++i) {
    const Vec2f u = pair(uint32_t(i));
    observed[size_t(u.x * n) * n + size_t(u.y * n)] += 1;
  }
  return test::chi_square_p_value(observed, expected);
}

struct Place {
  uint32_t stream, block;
  uint64_t seed;
};
constexpr Place places[] = {
    {0, 0, 0}, {0, 1, 0}, {7, 0, 0}, {123456, 5, 1}, {0xffffffff, 40, 0xffffffffffffffff}};

TEST(Sampler, PureFunctionOfItsArguments) {
  for (const Place& p : places)
    for (const uint32_t index : {0u, 1u, 77u, 0xffffffffu})
      EXPECT_EQ(draw(p.stream, index, p.seed, p.block), draw(p.stream, index, p.seed, p.block));
}

TEST(Sampler, NumbersOfABlockDoNotDependOnOtherBlocks) {
  Sampler sampler(3, 9, 4);
  sampler.start_block(2);
  (void)sampler.next2();
  sampler.start_block(9);
  (void)sampler.next1();
  sampler.start_block(5);
  const auto expected = draw(3, 9, 4, 5);
  for (const float number : expected) EXPECT_EQ(sampler.next1(), number);
}

TEST(Sampler, PairsAreTwoNumbers) {
  Sampler sampler(3, 9, 4);
  sampler.start_block(1);
  const auto expected = draw(3, 9, 4, 1);
  EXPECT_EQ(sampler.next1(), expected[0]);
  EXPECT_EQ(sampler.next2(), Vec2f(expected[1], expected[2]));
}

// Numbers of 53 digits begin with the digits of the others, and take as much of the block.
TEST(Sampler, FineNumbersRefineTheOthers) {
  for (uint32_t index = 0; index < 1000; ++index) {
    Sampler sampler(3, index, 4);
    const auto coarse = draw(3, index, 4, 0);
    for (int d = 0; d < 6; ++d) {
      const double fine = sampler.next1_fine();
      ASSERT_LT(fine, 1);
      ASSERT_EQ(float(uint32_t(fine * 0x1p24)) * 0x1p-24f, coarse[size_t(d)]);
    }
    const Vec2d pair = sampler.next2_fine();
    ASSERT_NEAR(pair.x, coarse[6], 0x1p-24);
    ASSERT_NEAR(pair.y, coarse[7], 0x1p-24);
  }
}

// Digits after those of the Sobol' points are random: uniform, and independent of those before and of other
// dimensions'.
TEST(Sampler, DigitsBeyondThePointsAreRandom) {
  const auto beyond = [](double u) { return float(u * 0x1p32 - std::floor(u * 0x1p32)); };
  EXPECT_TRUE(test::confirmed(significance, 200'000, [&](uint64_t seed, uint64_t samples) {
    return uniformity(samples, [&](uint32_t i) {
      Sampler sampler(5, i, seed);
      const double u = sampler.next1_fine(), v = sampler.next1_fine();
      return Vec2f(beyond(u), beyond(v));
    });
  }));
  EXPECT_TRUE(test::confirmed(significance, 200'000, [&](uint64_t seed, uint64_t samples) {
    return uniformity(samples, [&](uint32_t i) {
      const double u = Sampler(i, 0, seed).next1_fine();
      return Vec2f(float(u * 0x1p24 - std::floor(u * 0x1p24)), beyond(u));
    });
  }));
}

TEST(Sampler, StartsAtBlockZero) {
  Sampler sampler(3, 9, 4);
  EXPECT_EQ(sampler.next1(), draw(3, 9, 4, 0)[0]);
}

TEST(Sampler, NumbersAreInTheHalfOpenUnitInterval) {
  for (uint32_t stream = 0; stream < 2000; ++stream)
    for (const float number : draw(stream, stream * 7, 1, stream % 5)) {
      ASSERT_GE(number, 0);
      ASSERT_LT(number, 1);
    }
}

// Of 2^k samples from a multiple of 2^k, each of the 2^k equal intervals has one, in every dimension of every
// block.
TEST(Sampler, EveryAlignedRunIsStratifiedInEachDimension) {
  for (const Place& p : places)
    for (const int k : {0, 1, 4, 8})
      for (const uint32_t run : {0u, 1u, 5u, 1000u}) {
        const uint32_t n = 1u << k;
        std::vector<int> hits(size_t(n) * dimensions);
        for (uint32_t i = 0; i < n; ++i) {
          const auto numbers = draw(p.stream, run * n + i, p.seed, p.block);
          for (int d = 0; d < dimensions; ++d) ++hits[size_t(d) * n + size_t(numbers[d] * float(n))];
        }
        for (const int count : hits) ASSERT_EQ(count, 1) << "2^" << k << " samples, run " << run;
      }
}

// The first two dimensions are a (0, 2)-sequence in base 2: every elementary interval 2^-a x 2^-b, a + b = k,
// has one of 2^k samples.
TEST(Sampler, FirstTwoDimensionsFillEveryElementaryInterval) {
  for (const Place& p : places)
    for (const int k : {2, 5, 8})
      for (const uint32_t run : {0u, 3u, 100u})
        for (int a = 0; a <= k; ++a) {
          const uint32_t n = 1u << k, columns = 1u << a, rows = 1u << (k - a);
          std::vector<int> hits(n);
          for (uint32_t i = 0; i < n; ++i) {
            const auto numbers = draw(p.stream, run * n + i, p.seed, p.block);
            ++hits[size_t(numbers[0] * float(columns)) * rows + size_t(numbers[1] * float(rows))];
          }
          for (const int count : hits) ASSERT_EQ(count, 1) << columns << "x" << rows << ", run " << run;
        }
}

TEST(Sampler, UniformAndIndependentOverStreams) {
  // One sample of many streams: every pair of dimensions, and the first dimensions of neighbouring blocks.
  for (const uint32_t index : {0u, 1u, 6u})
    for (int d = 1; d < dimensions; ++d)
      EXPECT_TRUE(test::confirmed(significance, 200'000,
                                  [&](uint64_t seed, uint64_t samples) {
                                    return uniformity(samples, [&](uint32_t stream) {
                                      const auto numbers = draw(stream, index, seed, 1);
                                      return Vec2f(numbers[d - 1], numbers[d]);
                                    });
                                  }))
          << "index " << index << ", dimensions " << d - 1 << " and " << d;
}

TEST(Sampler, BlocksAreIndependentOfEachOther) {
  for (const uint32_t block : {0u, 1u, 8u})
    for (const int d : {0, 1, 5})
      EXPECT_TRUE(test::confirmed(significance, 200'000,
                                  [&](uint64_t seed, uint64_t samples) {
                                    return uniformity(samples, [&](uint32_t stream) {
                                      return Vec2f(draw(stream, 3, seed, block)[d],
                                                   draw(stream, 3, seed, block + 1)[d]);
                                    });
                                  }))
          << "block " << block << ", dimension " << d;
}

TEST(Sampler, NeighbouringStreamsAndSeedsAreIndependent) {
  EXPECT_TRUE(test::confirmed(significance, 200'000, [](uint64_t seed, uint64_t samples) {
    return uniformity(samples, [&](uint32_t i) {
      return Vec2f(draw(2 * i, 0, seed, 0)[0], draw(2 * i + 1, 0, seed, 0)[0]);
    });
  }));
  EXPECT_TRUE(test::confirmed(significance, 200'000, [](uint64_t seed, uint64_t samples) {
    return uniformity(samples,
                      [&](uint32_t i) { return Vec2f(draw(i, 0, seed, 0)[0], draw(i, 0, seed + 1, 0)[0]); });
  }));
}

// Each sample of a stream is uniform by itself, so that any number of samples, not only 2^k, has the right
// mean.
TEST(Sampler, EverySampleIndexIsUnbiased) {
  for (const uint32_t index : {0u, 1u, 2u, 3u, 17u, 255u})
    EXPECT_TRUE(test::confirmed(significance, 200'000, [&](uint64_t seed, uint64_t samples) {
      test::Samples sums;
      for (uint32_t stream = 0; stream < samples; ++stream) sums.add(draw(stream, index, seed, 2)[0]);
      return test::mean_p_value(sums, 0.5);
    })) << index;
}

// Owen scrambling converges at about N^-3/2 on smooth integrands; plain random numbers at N^-1/2.
TEST(Sampler, ErrorOfASmoothIntegrandFallsFasterThanRandom) {
  const auto rms_error = [](uint32_t n) {
    double squares = 0;
    constexpr int streams = 200;
    for (uint32_t stream = 0; stream < streams; ++stream) {
      double sum = 0;
      for (uint32_t i = 0; i < n; ++i) {
        const auto numbers = draw(stream, i, 1, 1);
        sum += double(numbers[0]) * numbers[1];
      }
      const double error = sum / n - 0.25;
      squares += error * error;
    }
    return std::sqrt(squares / streams);
  };
  const double slope = std::log2(rms_error(16) / rms_error(256)) / 4;
  EXPECT_GT(slope, 1.1);
}

}  // namespace
}  // namespace vernier
