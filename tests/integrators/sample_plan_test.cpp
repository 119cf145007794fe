// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/sample_plan.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <optional>
#include <set>

#include "core/base/parallel.h"

namespace vernier::test {
namespace {

constexpr int side = 40;
constexpr int pixels = side * side;

/// After 16 samples a pixel, with guides that have seen them: half of those of the first `noisy` pixels are
/// 1, all others 0.
struct Seen {
  SamplesDrawn drawn{{8, 8}, std::vector<uint32_t>(size_t(pixels) * Film::halves)};
  std::array<SampleStatistics, Film::halves> guides{SampleStatistics(side, side),
                                                    SampleStatistics(side, side)};

  explicit Seen(int noisy) {
    for (int i = 0; i < pixels * 16; ++i) {
      const int x = i / 16 % side, y = i / 16 / side, half = i % 2;
      const float value = i / 16 < noisy && i / 2 % 2 == 0 ? 1 : 0;
      guides[size_t(half)].add(x, y, {value, value, value});
    }
  }
  SamplePlan plan(uint32_t size) const { return SamplePlan::adaptive(drawn, guides, size); }
};

double samples_per_pixel(const SamplePlan& plan) {
  double sum = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int half = 0; half < Film::halves; ++half) sum += plan.count(x, y, half, plan.size());
  return sum / pixels;
}

TEST(SamplePlan, HoldsAsManySamplesAsItSays) {
  for (const int noisy : {pixels, pixels / 2, 300, 10 * side, 2 * side, side, 1, 0})
    for (const uint32_t size : {16u, 64u, 257u}) {
      const SamplePlan plan = Seen(noisy).plan(size);
      EXPECT_EQ(plan.size(), size);
      EXPECT_NEAR(samples_per_pixel(plan), size, 0.002 * size) << noisy << " pixels, " << size;
    }
}

// Counted in blocks of pixels, of which a row of this picture is none.
TEST(SamplePlan, OfALargePictureHoldsWhatItSaysForAnyNumberOfThreads) {
  constexpr int width = 301, height = 199;
  SamplesDrawn drawn{{8, 8}, std::vector<uint32_t>(size_t(width) * height * Film::halves, 3)};
  std::array<SampleStatistics, Film::halves> guides{SampleStatistics(width, height),
                                                    SampleStatistics(width, height)};
  for (int i = 0; i < width * height * 16; ++i) {
    const int pixel = i / 16;
    const float value =
        float((int64_t(pixel) * 7919 + int64_t(i) * 104729) % 1009) / 1009 * float(pixel % width) / width;
    guides[size_t(i % 2)].add(pixel % width, pixel / width, {value, value, 0.5f * value});
  }
  const auto counts = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return SamplePlan::adaptive(drawn, guides, 16).numbers().counts;
  };
  const std::vector<uint16_t> expected = counts(1);
  const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
  EXPECT_NEAR(sum / (width * height), 16, 0.001 * 16);
  EXPECT_EQ(counts(2), expected);
  EXPECT_EQ(counts(7), expected);
}

// A pixel gets at most eight times its even share, but where few need samples more, up to 64 times; what
// these cannot take goes to all others.
TEST(SamplePlan, SpendsOnFewPixelsWhatTheyCanTake) {
  const SamplePlan half = Seen(pixels / 2).plan(16);
  EXPECT_EQ(half.count(20, 39, 0, 16), 2u);
  const SamplePlan row = Seen(side).plan(16);  // a row, and the one beside it, whose neighbors warn it
  EXPECT_NEAR(row.count(20, 0, 0, 16), 2 + 0.75 * 8 * 20, 4);
  EXPECT_EQ(row.count(20, 20, 0, 16), 2u);
  const SamplePlan corner = Seen(1).plan(16);  // and three neighbors
  EXPECT_NEAR(corner.count(0, 0, 0, 16), 512, 1);
  EXPECT_NEAR(corner.count(20, 20, 0, 16), 8 - 512. * 4 / pixels, 1);
}

TEST(SamplePlan, IsEvenWhereNothingIsKnownToNeedMore) {
  const SamplePlan plan = Seen(0).plan(16);
  EXPECT_EQ(plan.count(20, 20, 0, plan.size()), 8u);
  EXPECT_EQ(plan.guiding_count(0), 2u);
}

// Neither the size of a pass nor any number of one half follows from what the half has found itself, and how
// many samples guide follows from nothing that was found.
TEST(SamplePlan, OfOneHalfDoesNotDependOnItsOwnLuck) {
  for (const int other : {0, 1, side, pixels}) {
    std::optional<std::vector<uint32_t>> expected;
    for (const int own : {0, 1, 3 * side, pixels}) {
      Seen seen(other);
      seen.guides[0] = Seen(own).guides[0];
      const SamplePlan plan = seen.plan(24);
      std::vector<uint32_t> counts{plan.size(), plan.guiding_count(0), plan.guiding_count(1)};
      for (int i = 0; i < pixels; ++i) counts.push_back(plan.count(i % side, i / side, 0, plan.size()));
      if (!expected) expected = counts;
      EXPECT_EQ(counts, *expected) << own << ", " << other;
    }
  }
}

// Those that guide and the others have all indices between them and none in common, and after each eight of
// an even share, no gap is left.
TEST(SamplePlan, EachSampleHasAnIndexOfItsOwn) {
  std::set<uint32_t> seen;
  for (uint32_t n = 0; n < pilot / 2; ++n) seen.insert(guiding_index(n));
  for (uint32_t pass = 0; pass < 100; ++pass) {
    for (uint32_t n = 0; n < 2; ++n) seen.insert(guiding_index(pilot / 2 + 2 * pass + n));
    for (uint32_t n = 0; n < 6; ++n) seen.insert(extra_index(6 * pass + n));
    ASSERT_EQ(seen.size(), pilot / 2 + 8 * (pass + 1));
    ASSERT_EQ(*seen.rbegin(), seen.size() - 1);
  }
  // Those that guide are by themselves in each eighth of an index's range by turns.
  std::array<int, 8> places{};
  for (uint32_t n = pilot / 2; n < pilot / 2 + 80; ++n) ++places[guiding_index(n) % 8];
  for (const int count : places) EXPECT_EQ(count, 10);
}

// Samples that come out alike in one half say nothing of the other.
TEST(SamplePlan, OfOneHalfFollowsTheOther) {
  Seen seen(pixels);
  seen.guides[0] = Seen(side * 20).guides[0];
  const SamplePlan plan = seen.plan(16);
  EXPECT_EQ(plan.count(20, 35, 1, plan.size()), 2u);
  EXPECT_NEAR(plan.count(20, 35, 0, plan.size()), 8, 1);
}

}  // namespace
}  // namespace vernier::test
