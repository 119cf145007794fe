#include "integrators/sample_plan.h"

#include <gtest/gtest.h>

#include <array>

namespace vernier::test {
namespace {

constexpr int side = 40;
constexpr int pixels = side * side;

/// A film of 16 samples a pixel with guides that have seen them: half of those of the first `noisy` pixels
/// are 1, all others 0.
struct Seen {
  Film film{side, side};
  std::array<SampleGuide, Film::halves> guides{SampleGuide(side, side), SampleGuide(side, side)};

  explicit Seen(int noisy) {
    for (int i = 0; i < pixels * 16; ++i) {
      const int x = i / 16 % side, y = i / 16 / side, half = i % 2;
      const float value = i / 16 < noisy && i / 2 % 2 == 0 ? 1 : 0;
      EXPECT_TRUE(film.add(x, y, half, {value, value, value}));
      guides[size_t(half)].add(x, y, {value, value, value});
    }
  }
  SamplePlan plan(uint32_t size) const { return SamplePlan::adaptive(film, guides, size); }
};

double samples_per_pixel(const SamplePlan& plan) {
  double sum = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int half = 0; half < Film::halves; ++half) sum += plan.count(x, y, half, plan.size());
  return sum / pixels;
}

TEST(SamplePlan, HoldsAsManySamplesAsItSays) {
  for (const int noisy : {pixels, pixels / 2, 300, 10 * side, 2 * side, side, 1})
    for (const uint32_t size : {16u, 64u, 257u}) {
      const SamplePlan plan = Seen(noisy).plan(size);
      EXPECT_LE(plan.size(), size);
      EXPECT_NEAR(samples_per_pixel(plan), plan.size(), 0.002 * size) << noisy << " pixels, " << size;
    }
}

// A pixel gets at most eight times its even share. When all that need samples have that, the pass ends.
TEST(SamplePlan, IsSmallerWhereFewPixelsNeedSamples) {
  EXPECT_EQ(Seen(pixels).plan(16).size(), 16u);
  const SamplePlan plan = Seen(side).plan(16);  // a row, and the one beside it, whose neighbours warn it
  EXPECT_EQ(plan.size(), 10u);                  // 4 everywhere, 128 in a twentieth of the pixels
  EXPECT_NEAR(plan.count(20, 0, 0, plan.size()), 64, 4);
  EXPECT_EQ(plan.count(20, 20, 0, plan.size()), 2u);
}

TEST(SamplePlan, IsEvenWhereNothingIsKnownToNeedMore) {
  const SamplePlan plan = Seen(0).plan(16);
  EXPECT_EQ(plan.size(), 16u);
  EXPECT_EQ(plan.count(20, 20, 0, plan.size()), 8u);
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
