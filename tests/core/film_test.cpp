// SPDX-License-Identifier: Apache-2.0
#include "core/film/film.h"

#include <gtest/gtest.h>

#include <limits>

namespace vernier {
namespace {

TEST(Film, PixelIsTheMeanOfItsHalves) {
  Film film(2, 1);
  EXPECT_TRUE(film.add(0, 0, 0, {1, 2, 3}));
  EXPECT_TRUE(film.add(0, 0, 0, {2, 4, 6}));
  EXPECT_TRUE(film.add(0, 0, 1, {6, 0, 0}));
  EXPECT_EQ(film.samples(0, 0), 3);
  EXPECT_EQ(film.samples(0, 0, 0), 2);
  EXPECT_EQ(film.samples(0, 0, 1), 1);
  EXPECT_EQ(film.half_mean(0, 0, 0), Vec3d(1.5, 3, 4.5));
  EXPECT_EQ(film.half_mean(0, 0, 1), Vec3d(6, 0, 0));
  // Not the mean of all samples, whose weights would depend on how many there are: that would be 3, 2, 3.
  EXPECT_EQ(rgb_at(film.image(), 0, 0), Rgb(3.75f, 1.5f, 2.25f));
}

TEST(Film, PixelWithoutSamplesIsBlack) {
  const Film film(3, 2);
  EXPECT_EQ(film.samples(2, 1), 0);
  EXPECT_EQ(film.half_mean(2, 1, 1), Vec3d(0, 0, 0));
  const Image mean = film.image();
  EXPECT_EQ(mean.width, 3);
  EXPECT_EQ(mean.height, 2);
  EXPECT_EQ(mean.channels, 3);
  for (const float value : mean.values) EXPECT_EQ(value, 0);
}

TEST(Film, PixelsAndHalvesAreApart) {
  Film film(3, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x)
      for (int g = 0; g < 2; ++g) EXPECT_TRUE(film.add(x, y, g, Rgb(float(x), float(y), float(g))));
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) {
      for (int g = 0; g < 2; ++g) EXPECT_EQ(film.half_mean(x, y, g), Vec3d(x, y, g));
      EXPECT_EQ(rgb_at(film.image(), x, y), Rgb(float(x), float(y), 0.5f));
    }
}

TEST(Film, BadSamplesAreRefusedAndChangeNothing) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  Film film(1, 1);
  EXPECT_TRUE(film.add(0, 0, 0, {1, 1, 1}));
  for (const float bad : {inf, -inf, nan, -1.f, -1e-30f})
    for (int c = 0; c < 3; ++c) {
      Rgb sample(1, 1, 1);
      sample[c] = bad;
      EXPECT_FALSE(film.add(0, 0, 0, sample)) << bad << " in channel " << c;
    }
  EXPECT_EQ(film.samples(0, 0), 1);
  EXPECT_EQ(rgb_at(film.image(), 0, 0), Rgb(1, 1, 1));
  EXPECT_TRUE(film.add(0, 0, 0, {0, 0, 0}));
  EXPECT_TRUE(film.add(0, 0, 0, {std::numeric_limits<float>::max(), 0, 0}));
}

TEST(Film, PixelOfOneHalfIsThatHalf) {
  for (const int half : {0, 1}) {
    Film film(1, 1);
    EXPECT_TRUE(film.add(0, 0, half, {2, 4, 8}));
    EXPECT_EQ(film.pixel(0, 0), Vec3d(2, 4, 8));
  }
}

TEST(Film, VarianceOfAHalfsMean) {
  Film film(1, 1);
  EXPECT_TRUE(film.add(0, 0, 1, {1, 5, 0}));
  EXPECT_EQ(film.half_mean_variance(0, 0, 1), Vec3d(0, 0, 0)) << "one sample shows no spread";
  EXPECT_TRUE(film.add(0, 0, 1, {2, 5, 0}));
  EXPECT_TRUE(film.add(0, 0, 1, {6, 5, 0}));
  // Squared deviations from 3: 4 + 1 + 9, over (n - 1) n.
  EXPECT_NEAR(film.half_mean_variance(0, 0, 1).x, 14.0 / 6, 1e-12);
  EXPECT_EQ(film.half_mean_variance(0, 0, 1).y, 0);
  EXPECT_EQ(film.half_mean_variance(0, 0, 0), Vec3d(0, 0, 0));
}

TEST(Film, VarianceIsNeverNegative) {
  Film film(1, 1);
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(film.add(0, 0, 0, {0.1f, 1e7f, 1e-20f}));
  const Vec3d variance = film.half_mean_variance(0, 0, 0);
  for (int c = 0; c < 3; ++c) EXPECT_GE(variance[c], 0);
  EXPECT_LT(variance.y, 1e-3);
}

TEST(Film, ShareOfTheLargestSample) {
  Film film(1, 1);
  EXPECT_EQ(film.largest_share(0, 0), 0);
  EXPECT_TRUE(film.add(0, 0, 0, {0, 0, 0}));
  EXPECT_EQ(film.largest_share(0, 0), 0);
  EXPECT_TRUE(film.add(0, 0, 0, {1, 0, 3}));
  EXPECT_EQ(film.largest_share(0, 0), 1);
  EXPECT_TRUE(film.add(0, 0, 1, {1, 2, 9}));
  EXPECT_DOUBLE_EQ(film.largest_share(0, 0), 9.0 / 12);
}

TEST(Film, MergedIsAsIfAddedToOne) {
  Film a(2, 1), b(2, 1), both(2, 1);
  for (int i = 0; i < 20; ++i) {
    const Rgb value(float(i % 7), float(i * i), 1);
    const int x = i % 2, half = i / 2 % 2;
    EXPECT_TRUE((i % 3 ? a : b).add(x, 0, half, value));
    EXPECT_TRUE(both.add(x, 0, half, value));
  }
  a.merge(b);
  for (int x = 0; x < 2; ++x) {
    EXPECT_EQ(a.pixel(x, 0), both.pixel(x, 0));
    EXPECT_EQ(a.sample_variance(x, 0), both.sample_variance(x, 0));
    EXPECT_EQ(a.largest_share(x, 0), both.largest_share(x, 0));
    for (int half = 0; half < Film::halves; ++half) {
      EXPECT_EQ(a.samples(x, 0, half), both.samples(x, 0, half));
      EXPECT_EQ(a.half_mean(x, 0, half), both.half_mean(x, 0, half));
    }
  }
}

TEST(Film, SumsInDouble) {
  Film film(1, 1);
  EXPECT_TRUE(film.add(0, 0, 0, {1e8f, 1e8f, 1e8f}));
  constexpr int count = 100'000;
  // In float each of these would be lost beside 1e8.
  for (int i = 0; i < count; ++i) EXPECT_TRUE(film.add(0, 0, 0, {1, 1, 1}));
  EXPECT_DOUBLE_EQ(film.half_mean(0, 0, 0).x, (1e8 + count) / (count + 1));
}

TEST(Film, AlphaIsWhatHidesTheBackground) {
  Film film(2, 1, true);
  EXPECT_EQ(film.alpha(0, 0), 0) << "without samples";
  ASSERT_TRUE(film.add(0, 0, 0, FilmSample{{1, 1, 1}, 0.5f}));
  EXPECT_EQ(film.alpha(0, 0), 0.5);
  ASSERT_TRUE(film.add(0, 0, 1, FilmSample{{1, 1, 1}, 0.25f}));
  ASSERT_TRUE(film.add(0, 0, 1, FilmSample{{1, 1, 1}, 0}));
  // As of the colours, the mean of the halves' means.
  EXPECT_EQ(film.alpha(0, 0), 1 - (0.5 + 0.125) / 2);
  EXPECT_FALSE(film.add(0, 0, 0, FilmSample{{1, 1, 1}, std::nanf("")}));
  EXPECT_FALSE(film.add(0, 0, 0, FilmSample{{1, 1, 1}, -0.1f}));
  EXPECT_EQ(film.samples(0, 0), 3);
  Film more(2, 1, true);
  ASSERT_TRUE(more.add(0, 0, 0, FilmSample{{1, 1, 1}, 1}));
  film.merge(more);
  EXPECT_EQ(film.alpha(0, 0), 1 - (0.75 + 0.125) / 2);
  EXPECT_EQ(Film(1, 1).alpha(0, 0), 1) << "without alpha";
}

TEST(Film, IsCoveredWhereAnySampleMetASurface) {
  Film film(2, 1), more(2, 1);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(film.add(0, 0, i % 2, FilmSample{{1, 1, 1}, 0, i == 3}));
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(film.add(1, 0, i % 2, FilmSample{{1, 1, 1}, 0, false}));
  EXPECT_EQ(film.coverage().values, (std::vector<float>{1, 0}));
  ASSERT_TRUE(more.add(1, 0, 0, {1, 1, 1}));
  film.merge(more);
  EXPECT_EQ(film.coverage().values, (std::vector<float>{1, 1}));
}

// The mean over all light paths is added to that over samples, and so is its variance.
TEST(Film, SplatsAddTheMeanOverLightPaths) {
  Film film(2, 1, false, true);
  for (const float value : {1.f, 3.f})
    for (int half = 0; half < Film::halves; ++half) ASSERT_TRUE(film.add(0, 0, half, Rgb(value)));
  EXPECT_EQ(film.half_mean(0, 0, 0).x, 2) << "no light path yet";
  const double variance_of_samples = film.half_mean_variance(0, 0, 0).x;
  film.splat(0, 0, 0, {4, 0, 0});
  film.splat(0, 0, 0, {2, 0, 0});
  film.count_light_paths(0, 8);
  film.count_light_paths(1, 4);
  EXPECT_EQ(film.splat_mean(0, 0, 0), Vec3d(0.75, 0, 0));
  EXPECT_EQ(film.half_mean(0, 0, 0), Vec3d(2.75, 2, 2));
  EXPECT_EQ(film.half_mean(0, 0, 1), Vec3d(2, 2, 2));
  EXPECT_EQ(film.pixel(0, 0), Vec3d(2.375, 2, 2));
  EXPECT_EQ(film.half_mean(1, 0, 0), Vec3d(0, 0, 0));
  // Eight values: 4, 2 and six times 0.
  const double spread = 16 + 4 - 36 / 8.;
  EXPECT_NEAR(film.half_mean_variance(0, 0, 0).x, variance_of_samples + spread / (7 * 8), 1e-12);
  EXPECT_EQ(film.half_mean_variance(0, 0, 0).y, variance_of_samples);
  // In the sum of samples, 8, the splats are worth 0.75 times two samples, the largest 1; a sample is
  // worth 3.
  EXPECT_NEAR(film.largest_share(0, 0), 3 / 9.5, 1e-12);
  film.splat(0, 0, 0, {20, 0, 0});
  EXPECT_NEAR(film.largest_share(0, 0), 5 / 14.5, 1e-12);
  EXPECT_TRUE(film.is_plausible());

  Film more(2, 1, false, true);
  more.splat(0, 0, 1, {6, 6, 6});
  more.count_light_paths(1, 2);
  film.merge(more);
  EXPECT_EQ(film.light_paths()[1], 6u);
  EXPECT_EQ(film.splat_mean(0, 0, 1), Vec3d(1, 1, 1));
}

}  // namespace
}  // namespace vernier
