// SPDX-License-Identifier: Apache-2.0
#include "vernier/transform.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/math/rounding.h"
#include "tests/support/random.h"

namespace vernier {
namespace {

Vec3f random_vector(test::Random& random, float scale) {
  const float x = random.next1(), y = random.next1(), z = random.next1();
  return (Vec3f(x, y, z) * 2.f - Vec3f(1, 1, 1)) * scale;
}

Transform random_transform(test::Random& random, float scale) {
  const Vec3f x = random_vector(random, scale), y = random_vector(random, scale),
              z = random_vector(random, scale);
  return {x, y, z, random_vector(random, 10 * scale)};
}

Vec3d exact_point(const Transform& t, const Vec3f& p) {
  return Vec3d(t.x) * double(p.x) + Vec3d(t.y) * double(p.y) + Vec3d(t.z) * double(p.z) + Vec3d(t.origin);
}

TEST(Transform, ColumnsAndTranslation) {
  const Transform t{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}, {100, 200, 300}};
  EXPECT_EQ(t.point({1, 0, 0}), Vec3f(101, 202, 303));
  EXPECT_EQ(t.vector({0, 1, 0}), Vec3f(4, 5, 6));
  EXPECT_EQ(t.transposed_vector({1, 1, 1}), Vec3f(6, 15, 25));
  EXPECT_DOUBLE_EQ(t.determinant(), -3);
  EXPECT_TRUE(Transform{}.is_identity());
  EXPECT_FALSE(t.is_identity());
}

TEST(Transform, InverseUndoes) {
  test::Random random(1);
  for (const float scale : {1e-3f, 1.f, 1e3f})
    for (int trial = 0; trial < 1000; ++trial) {
      const Transform t = random_transform(random, scale);
      const double volume = std::abs(t.determinant()) / std::pow(double(scale), 3);
      if (volume < 1e-2) continue;  // ill-conditioned: rounding of the input alone moves the result
      const auto inverse = t.inverse();
      ASSERT_TRUE(inverse);
      const Vec3f p = random_vector(random, 1);
      const Vec3f back = inverse->point(t.point(p));
      EXPECT_LT(length(back - p), 2e-3f) << scale;
      EXPECT_NEAR(inverse->determinant() * t.determinant(), 1, 1e-4);
    }
}

TEST(Transform, SingularOrNotFiniteHasNoInverse) {
  EXPECT_FALSE((Transform{{1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {0, 0, 0}}.inverse()));
  EXPECT_FALSE((Transform{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}.inverse()));
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_FALSE((Transform{{inf, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}.inverse()));
  EXPECT_FALSE((Transform{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {std::nanf(""), 0, 0}}.inverse()));
  // Its inverse does not fit in float.
  EXPECT_FALSE((Transform{{1e-39f, 0, 0}, {0, 1e-39f, 0}, {0, 0, 1e-39f}, {0, 0, 0}}.inverse()));
  // Tiny and huge scales that do fit: the determinant is far outside the range of float.
  EXPECT_TRUE((Transform{{1e-30f, 0, 0}, {0, 1e-30f, 0}, {0, 0, 1e-30f}, {0, 0, 0}}.inverse()));
  EXPECT_TRUE((Transform{{1e30f, 0, 0}, {0, 1e30f, 0}, {0, 0, 1e30f}, {0, 0, 0}}.inverse()));
}

TEST(Transform, NormalsStayPerpendicular) {
  test::Random random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const Transform t = random_transform(random, 1);
    if (std::abs(t.determinant()) < 1e-2) continue;
    const Vec3f a = random_vector(random, 1), b = random_vector(random, 1);
    const Vec3f normal = t.inverse()->transposed_vector(cross(a, b));
    for (const Vec3f& edge : {a, b}) {
      const Vec3f image = t.vector(edge);
      EXPECT_NEAR(dot(normal, image) / (length(normal) * length(image)), 0, 1e-3);
    }
  }
}

// absolute_point bounds what rounding does to point(): three products and three sums, each with one rounding.
TEST(Transform, AbsolutePointBoundsRounding) {
  test::Random random(3);
  double worst = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    const Transform t = random_transform(random, 1);
    const Vec3f p = random_vector(random, 5);
    const Vec3d error = abs(Vec3d(t.point(p)) - exact_point(t, p));
    const Vec3f bound = gamma_bound(4) * t.absolute_point(abs(p), 1);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_LE(error[axis], bound[axis]);
      worst = std::max(worst, error[axis] / bound[axis]);
    }
  }
  EXPECT_GT(worst, 0.1) << "the bound should not be idle";
}

}  // namespace
}  // namespace vernier
