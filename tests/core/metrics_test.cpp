// SPDX-License-Identifier: Apache-2.0
#include "core/compare/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "vernier/error.h"

namespace vernier {
namespace {

Image image_of(int width, int height, std::vector<float> values) {
  Image image(width, height, 3);
  image.values = std::move(values);
  return image;
}

TEST(Metrics, HandComputedValues) {
  // Differences of the six values: 1, 0, 0, 0, -2, 0.5.
  const Image x = image_of(2, 1, {1, 1, 1, 0.25f, 0, 0.5f});
  const Image r = image_of(2, 1, {0, 1, 1, 0.25f, 2, 0});
  const ImageDifference d = difference(x, r);
  EXPECT_DOUBLE_EQ(d.mse, (1 + 4 + 0.25) / 6);
  EXPECT_DOUBLE_EQ(d.rmse(), std::sqrt(5.25 / 6));
  EXPECT_DOUBLE_EQ(d.rel_mse, (1 / 0.01 + 4 / 4.01 + 0.25 / 0.01) / 6);
  EXPECT_DOUBLE_EQ(d.mae, 3.5 / 6);
  EXPECT_DOUBLE_EQ(d.largest, 2);
  EXPECT_EQ(d.largest_x, 1);
  EXPECT_EQ(d.largest_y, 0);
  EXPECT_EQ(d.mean, (std::array<double, 3>{0.625, 0.5, 0.75}));
  EXPECT_EQ(d.reference_mean, (std::array<double, 3>{0.125, 1.5, 0.5}));
  EXPECT_DOUBLE_EQ(d.reference_largest, 2);
  EXPECT_DOUBLE_EQ(d.psnr(1), 10 * std::log10(6 / 5.25));
  EXPECT_DOUBLE_EQ(d.psnr(2), 10 * std::log10(4 * 6 / 5.25));
  EXPECT_EQ(d.not_finite, 0);
}

TEST(Metrics, EqualPictures) {
  const Image x = image_of(1, 2, {1, -2, 3, 0, 1e30f, 1e-30f});
  const ImageDifference d = difference(x, x);
  EXPECT_EQ(d.mse, 0);
  EXPECT_EQ(d.rel_mse, 0);
  EXPECT_EQ(d.largest, 0);
  EXPECT_EQ(d.psnr(1), std::numeric_limits<double>::infinity());
}

TEST(Metrics, NotFiniteValuesAreCountedAndLeftOut) {
  const float inf = std::numeric_limits<float>::infinity();
  const Image x = image_of(2, 1, {std::nanf(""), 1, 1, 3, 1, 1});
  const Image r = image_of(2, 1, {inf, 1, -inf, 1, 1, 1});
  const ImageDifference d = difference(x, r);
  EXPECT_EQ(d.not_finite, 3);
  EXPECT_DOUBLE_EQ(d.mse, 4.0 / 4);
  EXPECT_EQ(d.mean, (std::array<double, 3>{3, 1, 1}));
  EXPECT_DOUBLE_EQ(d.reference_largest, 1);
  const Image all_bad = image_of(1, 1, {inf, inf, inf});
  EXPECT_EQ(difference(all_bad, all_bad).not_finite, 6);
  EXPECT_EQ(difference(all_bad, all_bad).mse, 0);
}

TEST(Metrics, LargestIsTheFirstInReadingOrder) {
  Image x(8, 8, 3), r(8, 8, 3);
  x.pixel(5, 2)[1] = 1;
  x.pixel(1, 6)[0] = 1;
  x.pixel(6, 2)[0] = -1;
  const ImageDifference d = difference(x, r);
  EXPECT_EQ(d.largest_x, 5);
  EXPECT_EQ(d.largest_y, 2);
}

TEST(Metrics, OneThreadGivesTheSameBits) {
  Image x(61, 47, 3), r(61, 47, 3);
  for (size_t i = 0; i < x.values.size(); ++i) {
    x.values[i] = std::sin(float(i)) * 1e3f;
    r.values[i] = std::cos(float(i) * 0.7f) * 1e-2f;
  }
  const ImageDifference many = difference(x, r);
  const ThreadLimit one(1);
  const ImageDifference single = difference(x, r);
  EXPECT_EQ(many.mse, single.mse);
  EXPECT_EQ(many.rel_mse, single.rel_mse);
  EXPECT_EQ(many.mean, single.mean);
}

TEST(Metrics, ExtraChannelsAreIgnored) {
  Image x(1, 1, 5), r(1, 1, 3);
  x.values = {1, 2, 3, 40, 50};
  r.values = {1, 2, 4};
  EXPECT_DOUBLE_EQ(difference(x, r).mse, 1.0 / 3);
}

TEST(Metrics, SizesMustAgree) {
  for (const Image& r : {Image(2, 3, 3), Image(3, 2, 3), Image(2, 2, 2)}) {
    try {
      difference(Image(2, 2, 3), r);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
    }
  }
}

}  // namespace
}  // namespace vernier
