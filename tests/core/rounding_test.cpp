// SPDX-License-Identifier: Apache-2.0
#include "core/math/rounding.h"

#include <gtest/gtest.h>

#include "core/sampling/warp.h"
#include "tests/support/random.h"

namespace vernier {
namespace {

TEST(Rounding, GammaBoundsChainedOperations) {
  EXPECT_EQ(gamma_bound(0), 0);
  EXPECT_GE(gamma_bound(1), 0x1p-24f);
  EXPECT_NEAR(gamma_bound(3), 3 * 0x1p-24, 1e-12);
  // A chain of n products stays within (1 +- gamma_n).
  test::Random random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    float product = 1;
    double exact = 1;
    for (int n = 1; n <= 32; ++n) {
      const float factor = 0.5f + random.next1();
      product *= factor;
      exact *= factor;
      ASSERT_LE(std::abs(product - exact), gamma_bound(n) * exact);
    }
  }
}

TEST(Rounding, NeighbouringFloats) {
  EXPECT_EQ(next_float_up(1), 1 + 0x1p-23f);
  EXPECT_EQ(next_float_down(1), 1 - 0x1p-24f);
  EXPECT_EQ(next_float_up(-1), -1 + 0x1p-24f);
  EXPECT_GT(next_float_up(0), 0);
  EXPECT_LT(next_float_down(0), 0);
}

TEST(Rounding, NeighboursAreThoseOfTheStandardLibrary) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr uint32_t special[]{0,          1,          0x80000000, 0x80000001, 0x7f7fffff,
                               0x7f800000, 0xff7fffff, 0xff800000, 0x00800000, 0x007fffff};
  test::Random random(5);
  const auto expect_neighbours = [&](uint32_t bits) {
    const float v = std::bit_cast<float>(bits);
    if (std::isnan(v)) {
      EXPECT_TRUE(std::isnan(next_float_up(v)) && std::isnan(next_float_down(v)));
      return;
    }
    EXPECT_EQ(next_float_up(v), std::nextafter(v, infinity)) << v;
    EXPECT_EQ(next_float_down(v), std::nextafter(v, -infinity)) << v;
  };
  for (const uint32_t bits : special) expect_neighbours(bits);
  for (int trial = 0; trial < 100'000; ++trial)
    expect_neighbours(uint32_t(random.next1() * 0x1p24f) << 8 | uint32_t(random.next1() * 0x1p8f));
}

// However the true surface point lies in the error box, the origin is on the side of the plane that the ray
// leaves by, in exact arithmetic (doubles hold these products exactly enough: 48 bits and a margin far above
// 1e-16).
TEST(Rounding, OffsetOriginClearsTheSurface) {
  test::Random random(2);
  for (const float scale : {1e-6f, 1e-3f, 1.f, 1e3f, 1e7f})
    for (int trial = 0; trial < 2000; ++trial) {
      const Vec3f p = sample_sphere(random.next2()) * scale;
      const Vec3f n = normalize(sample_sphere(random.next2()));
      const Vec3f error = abs(p) * gamma_bound(7) + Vec3f(1, 1, 1) * (scale * 1e-8f);
      const Vec3f direction = sample_sphere(random.next2());
      const Vec3f origin = offset_ray_origin(p, error, n, direction);
      const double side = dot(direction, n) < 0 ? -1 : 1;
      // The corner of the box that lies farthest toward the origin.
      const Vec3d corner = Vec3d(p) + side * Vec3d(std::copysign(error.x, n.x), std::copysign(error.y, n.y),
                                                   std::copysign(error.z, n.z));
      const double clearance = side * dot(Vec3d(origin) - corner, Vec3d(n));
      const double reach = dot(abs(Vec3d(n)), Vec3d(error));
      // |n| differs from 1 by rounding, which shifts the offset by a like part of itself.
      ASSERT_GE(clearance, -1e-6 * reach) << "scale " << scale;
      // Moving far would lose thin gaps: a few units in the last place beyond what the error demands.
      const double ulp = double(std::numeric_limits<float>::epsilon()) * scale;
      ASSERT_LE(length(Vec3d(origin) - Vec3d(p)), reach + 4 * ulp) << "scale " << scale;
    }
}

TEST(Rounding, OffsetFollowsTheDirection) {
  const Vec3f error{1e-4f, 1e-4f, 1e-4f}, n{0, 1, 0};
  EXPECT_GT(offset_ray_origin({0, 5, 0}, error, n, {0, 1, 0}).y, 5);
  EXPECT_LT(offset_ray_origin({0, 5, 0}, error, n, {0, -1, 0}).y, 5);
  EXPECT_EQ(offset_ray_origin({3, 5, 7}, error, n, {0, -1, 0}).x, 3);
}

}  // namespace
}  // namespace vernier
