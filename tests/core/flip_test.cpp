// SPDX-License-Identifier: Apache-2.0
#include "core/compare/flip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/parallel.h"
#include "vernier/error.h"

namespace vernier {
namespace {

Image constant(int width, int height, const Rgb& value) {
  Image image(width, height, 3);
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = value[int(i % 3)];
  return image;
}

struct Pair {
  Image x{64, 48, 3}, reference{64, 48, 3};
};

// Gradients with an edge, and the same with noise from a linear congruential generator.
Pair test_pair() {
  Pair pair;
  uint32_t state = 1;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c) {
        float value = 0.5f + 0.4f * std::sin(0.2f * float(x) * float(c + 1) * 0.7f + 0.13f * float(y));
        if (x > 30 && y > 20) value = 1 - value;
        pair.reference.pixel(x, y)[c] = value;
        state = state * 1664525u + 1013904223u;
        const float noise = float(state >> 8) / 16777216.f - 0.5f;
        pair.x.pixel(x, y)[c] = std::clamp(value + 0.3f * noise, 0.f, 1.f);
      }
  return pair;
}

Image linear_hdr(Image image) {
  for (float& value : image.values) value = 8 * value * value * value;
  return image;
}

// The expected numbers are of a separate implementation in double precision (NumPy, two-dimensional kernels,
// filters by scipy.ndimage), written from the papers.
TEST(Flip, AgreesWithASeparateImplementation) {
  const Pair pair = test_pair();
  const FlipResult result = flip(pair.x, pair.reference);
  EXPECT_NEAR(result.mean, 0.1670537, 2e-6);
  EXPECT_NEAR(*result.map.pixel(0, 0), 0.2496846, 1e-5);
  EXPECT_NEAR(*result.map.pixel(31, 20), 0.1789443, 1e-5);
  EXPECT_NEAR(*result.map.pixel(10, 40), 0.0410529, 1e-5);
}

TEST(Flip, HdrAgreesWithASeparateImplementation) {
  const Pair pair = test_pair();
  const FlipResult result = hdr_flip(linear_hdr(pair.x), linear_hdr(pair.reference));
  EXPECT_NEAR(result.mean, 0.2215542, 2e-6);
  EXPECT_NEAR(result.start_exposure, -1.460621, 1e-5);
  EXPECT_NEAR(result.stop_exposure, 0.678663, 1e-5);
  EXPECT_EQ(result.exposures, 3);
  EXPECT_NEAR(*result.map.pixel(31, 20), 0.2179319, 1e-5);
}

TEST(Flip, EqualPicturesDoNotDiffer) {
  const Pair pair = test_pair();
  for (const float value : flip(pair.x, pair.x).map.values) ASSERT_EQ(value, 0);
  for (const float value : hdr_flip(pair.x, pair.x).map.values) ASSERT_EQ(value, 0);
}

TEST(Flip, GreenAgainstBlueIsTheLargestDifference) {
  const FlipResult result = flip(constant(40, 40, {0, 1, 0}), constant(40, 40, {0, 0, 1}));
  EXPECT_NEAR(result.mean, 1, 1e-5);
}

TEST(Flip, SymmetricAndBounded) {
  const Pair pair = test_pair();
  const FlipResult ab = flip(pair.x, pair.reference), ba = flip(pair.reference, pair.x);
  EXPECT_EQ(ab.map.values, ba.map.values);
  for (const float value : ab.map.values) {
    ASSERT_GE(value, 0);
    ASSERT_LE(value, 1);
  }
}

TEST(Flip, CloserEyesSeeMore) {
  const Pair pair = test_pair();
  EXPECT_LT(flip(pair.x, pair.reference, 67).mean, flip(pair.x, pair.reference, 20).mean);
}

TEST(Flip, HdrDoesNotDependOnTheScale) {
  const Pair pair = test_pair();
  Image x = linear_hdr(pair.x), reference = linear_hdr(pair.reference);
  const FlipResult here = hdr_flip(x, reference);
  for (float& value : x.values) value *= 1024;
  for (float& value : reference.values) value *= 1024;
  const FlipResult there = hdr_flip(x, reference);
  EXPECT_NEAR(there.mean, here.mean, 1e-5);
  EXPECT_NEAR(there.start_exposure, here.start_exposure - 10, 1e-4);
}

TEST(Flip, HdrFindsDifferencesInTheDark) {
  // A lamp sets the shortest exposure; in the shadow the picture is half as bright as it should be.
  Image reference = constant(40, 40, {0.01f, 0.01f, 0.01f});
  for (int x = 0; x < 5; ++x)
    for (int c = 0; c < 3; ++c) reference.pixel(x, 0)[c] = 100;
  Image darker = reference;
  darker.pixel(30, 30)[1] = 0.005f;
  const FlipResult result = hdr_flip(darker, reference);
  EXPECT_GT(result.exposures, 10);
  EXPECT_GT(*result.map.pixel(30, 30), 0.05f);
  EXPECT_LT(*result.map.pixel(10, 10), 0.001f);
}

TEST(Flip, BlackAndBadValuesAreSafe) {
  const float inf = INFINITY, nan = NAN;
  Image bad = constant(16, 16, {0.5f, 0.5f, 0.5f});
  bad.pixel(3, 3)[0] = nan;
  bad.pixel(8, 8)[1] = inf;
  bad.pixel(12, 12)[2] = -inf;
  const Image good = constant(16, 16, {0.5f, 0.5f, 0.5f}), black = constant(16, 16, {0, 0, 0});
  for (const FlipResult& result : {flip(bad, good), hdr_flip(bad, good), hdr_flip(good, bad),
                                   hdr_flip(good, black), hdr_flip(bad, black)})
    for (const float value : result.map.values) {
      ASSERT_GE(value, 0);
      ASSERT_LE(value, 1);
    }
  EXPECT_EQ(hdr_flip(black, black).mean, 0);
}

TEST(Flip, OneThreadGivesTheSameBits) {
  const Pair pair = test_pair();
  const FlipResult many = hdr_flip(pair.x, pair.reference);
  const ThreadLimit one(1);
  EXPECT_EQ(hdr_flip(pair.x, pair.reference).map.values, many.map.values);
}

TEST(Flip, SizesMustAgree) {
  EXPECT_THROW(flip(Image(2, 3, 3), Image(3, 2, 3)), Error);
  EXPECT_THROW(hdr_flip(Image(2, 3, 1), Image(2, 3, 3)), Error);
}

}  // namespace
}  // namespace vernier
