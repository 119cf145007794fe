// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/spherical_triangle.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/sampling/warp.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace vernier {
namespace {

struct Case {
  const char* name;
  Vec3f a, b, c;  ///< seen from the origin
};

const Case cases[] = {
    {"octant", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {"near a corner", {-0.05f, 0.1f, -0.02f}, {2, 0.2f, 0}, {0, 0.3f, 1.5f}},
    {"close above", {-1, 0.02f, -1}, {1, 0.02f, -1}, {0, 0.02f, 1}},
    {"sliver", {-3, 1, 0}, {3, 1, 0}, {3, 1, 0.01f}},
    {"grazing", {1, 0.01f, -1}, {1, 0.01f, 1}, {3, 0.01f, 0}},
    {"far", {900, 300, 0}, {901, 300, 0}, {900, 301, 0.5f}},
    {"far from the origin of the world", {0.5f, 0.5f, 0}, {0.5f, -0.5f, 0.5f}, {0.75f, 0, -0.5f}},
};

SphericalTriangle seen(const Case& t) { return {t.a, t.b, t.c, cross(t.b - t.a, t.c - t.a)}; }

/// Solid angle of the part of the triangle that a cell of the square maps to, by quadrature over its area.
double cell_solid_angle(const Case& t, int x, int y, int cells) {
  const Vec3d a(t.a), ab(t.b - t.a), ac(t.c - t.a), normal = cross(ab, ac);
  const auto integrand = [&](double u, double v) {
    double s = (x + u) / cells, r = (y + v) / cells;
    if (r > s) {
      s /= 2;
      r -= s;
    } else {
      r /= 2;
      s -= r;
    }
    const Vec3d p = a + ab * s + ac * r;
    return std::abs(dot(p, normal)) / 2 / std::pow(length(p), 3);
  };
  return test::integrate_square(integrand, 1e-9, 20'000).value / (cells * cells);
}

TEST(SphericalTriangle, SolidAngleIsThatOfTheArea) {
  EXPECT_NEAR(seen(cases[0]).solid_angle(), pi / 2, 1e-6);
  for (const Case& t : cases) {
    double expected = 0;
    for (int i = 0; i < 64; ++i) expected += cell_solid_angle(t, i % 8, i / 8, 8);
    EXPECT_NEAR(seen(t).solid_angle() / expected, 1, 1e-4) << t.name;
  }
}

// Each cell of a grid over the triangle gets samples in proportion to its solid angle.
TEST(SphericalTriangle, SamplesAreUniform) {
  constexpr int cells = 12;
  for (const Case& t : cases) {
    const SphericalTriangle triangle = seen(t);
    std::vector<double> shares(size_t(cells) * cells);
    for (int i = 0; i < cells * cells; ++i)
      shares[size_t(i)] = cell_solid_angle(t, i % cells, i / cells, cells) / double(triangle.solid_angle());
    EXPECT_TRUE(test::confirmed(test::sidak(1e-3, std::size(cases)), 100'000,
                                [&](uint64_t seed, uint64_t count) {
                                  test::Random random(seed);
                                  std::vector<double> observed(shares.size()), expected(shares);
                                  for (uint64_t i = 0; i < count; ++i) {
                                    const Vec2f u = invert_sample_triangle(triangle.sample(random.next2()));
                                    const int x = std::clamp(int(u.x * cells), 0, cells - 1),
                                              y = std::clamp(int(u.y * cells), 0, cells - 1);
                                    ++observed[size_t(y * cells + x)];
                                  }
                                  for (double& e : expected) e *= double(count);
                                  return test::chi_square_p_value(observed, expected);
                                }))
        << t.name;
  }
}

TEST(SphericalTriangle, EdgeOnAndFromACornerThereIsNone) {
  const auto solid_angle = [](const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    return seen({"", a, b, c}).solid_angle();
  };
  EXPECT_EQ(solid_angle({1, 0, 0}, {2, 0, 0}, {1, 0, 1}), 0);     // in its plane, beside it
  EXPECT_EQ(solid_angle({-1, 0, -1}, {2, 0, -1}, {0, 0, 2}), 0);  // within it
  EXPECT_EQ(solid_angle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0);     // at a corner
  EXPECT_EQ(solid_angle({-1, 0, 0}, {1, 0, 0}, {0, 0, 1}), 0);    // on an edge
  EXPECT_EQ(solid_angle({1, 1, 1}, {2, 2, 2}, {3, 3, 3}), 0);     // no area
}

// From hardly above its plane, its edges or its corners: still points of the triangle.
TEST(SphericalTriangle, HardlyAboveThePlaneSamplesStayOnTheTriangle) {
  test::Random random(5);
  int sampled = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Vec3f a(-1, 0, -1), b(1.5f, 0, -1), c(0, 0, 1);
    const float height = std::pow(10.f, -9 * random.next1());
    const float s = std::max(0.f, 1.4f * random.next1() - 0.2f),
                r = std::max(0.f, 1.4f * random.next1() - 0.2f);
    const Vec3f from = a + (b - a) * s + (c - a) * r + Vec3f(0, height, 0);
    const SphericalTriangle triangle = seen({"", a - from, b - from, c - from});
    if (!(triangle.solid_angle() > 0)) continue;
    ++sampled;
    const Vec2f place = triangle.sample(random.next2());
    ASSERT_TRUE(place.x >= 0 && place.y >= 0 && place.x + place.y <= 1 + 1e-6f) << from << " " << place;
    ASSERT_LE(triangle.solid_angle(), 2 * pi + 1e-5f);
  }
  EXPECT_GT(sampled, 90'000);
}

}  // namespace
}  // namespace vernier
