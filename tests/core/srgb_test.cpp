// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "vernier/image.h"

namespace vernier {
namespace {

TEST(Srgb, EveryByteSurvivesTheRoundTrip) {
  for (int i = 0; i < 256; ++i)
    EXPECT_EQ(std::lround(linear_to_srgb(srgb_to_linear(float(i) / 255)) * 255), i);
}

TEST(Srgb, KnownValues) {
  EXPECT_EQ(srgb_to_linear(0), 0);
  EXPECT_FLOAT_EQ(srgb_to_linear(1), 1);
  EXPECT_EQ(linear_to_srgb(0), 0);
  EXPECT_NEAR(linear_to_srgb(1), 1, 1e-6);
  // IEC 61966-2-1: 0.5 encodes 0.21404114; 18 % grey is encoded as 0.46135613.
  EXPECT_NEAR(srgb_to_linear(0.5f), 0.21404114, 1e-7);
  EXPECT_NEAR(linear_to_srgb(0.18f), 0.46135613, 1e-6);
  EXPECT_NEAR(srgb_to_linear(10.f / 255), 10.0 / 255 / 12.92, 1e-8);
}

TEST(Srgb, MonotoneAcrossTheKnee) {
  for (int i = 0; i < 10'000; ++i) {
    const float a = float(i) / 10'000, b = float(i + 1) / 10'000;
    EXPECT_LT(srgb_to_linear(a), srgb_to_linear(b)) << a;
    EXPECT_LE(linear_to_srgb(a), linear_to_srgb(b)) << a;
  }
}

}  // namespace
}  // namespace vernier
