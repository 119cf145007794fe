// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/warp.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/quadrature.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace vernier {
namespace {

constexpr double significance = 1e-4;
constexpr uint64_t sample_count = 200'000;

double fraction(double x) { return x - std::floor(x); }

// Whether sample(u), given as a cell index, hits each cell as often as `probability` says.
template <typename CellOf>
bool fits(const std::vector<double>& probability, const CellOf& cell_of) {
  return test::confirmed(significance, sample_count, [&](uint64_t seed, uint64_t samples) {
    test::Random random(seed);
    std::vector<double> observed(probability.size()), expected(probability);
    for (uint64_t i = 0; i < samples; ++i) observed[cell_of(random.next2())] += 1;
    for (double& e : expected) e *= double(samples);
    return test::chi_square_p_value(observed, expected);
  });
}

constexpr int cos_cells = 24, phi_cells = 36;

size_t direction_cell(const Vec3f& w) {
  const int i = std::clamp(int((w.z + 1) / 2 * cos_cells), 0, cos_cells - 1);
  const double turn = fraction(std::atan2(w.y, w.x) / (2 * double(pi)));
  return size_t(i) * phi_cells + size_t(std::clamp(int(turn * phi_cells), 0, phi_cells - 1));
}

// Integral of a density about the z axis over each cell of the sphere; `pdf` takes the cosine.
template <typename Pdf>
std::vector<double> direction_probabilities(const Pdf& pdf) {
  std::vector<double> probabilities;
  for (int i = 0; i < cos_cells; ++i) {
    const double low = 2.0 * i / cos_cells - 1, width = 2.0 / cos_cells;
    const double ring =
        test::integrate_square([&](double x, double) { return pdf(float(low + x * width)); }, 1e-7).value *
        width;
    for (int j = 0; j < phi_cells; ++j) probabilities.push_back(ring * 2 * double(pi) / phi_cells);
  }
  return probabilities;
}

TEST(Warp, CosineHemisphereFitsItsPdf) {
  EXPECT_TRUE(fits(direction_probabilities(cosine_hemisphere_pdf),
                   [](const Vec2f& u) { return direction_cell(sample_cosine_hemisphere(u)); }));
  EXPECT_EQ(cosine_hemisphere_pdf(-0.5f), 0);
}

TEST(Warp, SphereFitsItsPdf) {
  EXPECT_TRUE(fits(direction_probabilities([](float) { return sphere_pdf(); }),
                   [](const Vec2f& u) { return direction_cell(sample_sphere(u)); }));
}

TEST(Warp, PdfsIntegrateToOne) {
  for (const auto& probabilities : {direction_probabilities(cosine_hemisphere_pdf),
                                    direction_probabilities([](float) { return sphere_pdf(); })}) {
    double sum = 0;
    for (const double p : probabilities) sum += p;
    EXPECT_NEAR(sum, 1, 1e-5);
  }
}

TEST(Warp, DiskIsUniform) {
  constexpr int rings = 20, sectors = 32;  // rings of equal area
  EXPECT_TRUE(fits(std::vector<double>(rings * sectors, 1.0 / (rings * sectors)), [](const Vec2f& u) {
    const Vec2f d = sample_disk(u);
    const int ring = std::clamp(int((d.x * d.x + d.y * d.y) * rings), 0, rings - 1);
    const double turn = fraction(std::atan2(d.y, d.x) / (2 * double(pi)));
    return size_t(ring) * sectors + size_t(std::clamp(int(turn * sectors), 0, sectors - 1));
  }));
}

TEST(Warp, TriangleIsUniform) {
  // n^2 small triangles of equal area: in each square of the grid the one below the diagonal, and the one
  // above it where that lies inside.
  constexpr int n = 16;
  const auto cell_of = [](const Vec2f& u) {
    const Vec2f b = sample_triangle(u);
    const int i = std::clamp(int(b.x * n), 0, n - 1), j = std::clamp(int(b.y * n), 0, n - 1 - i);
    const bool above = (b.x * n - float(i)) + (b.y * n - float(j)) > 1 && i + j < n - 1;
    return size_t(2 * (i * n + j) + above);
  };
  std::vector<double> probabilities(2 * n * n, 0.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      probabilities[2 * (i * n + j)] = 1.0 / (n * n);
      if (i + j < n - 1) probabilities[2 * (i * n + j) + 1] = 1.0 / (n * n);
    }
  EXPECT_TRUE(fits(probabilities, cell_of));
}

TEST(Warp, StaysInItsDomainAtTheEdges) {
  const float last = 0x1.fffffep-1f;
  for (const float x : {0.f, 1e-30f, 0.25f, 0.5f, 0.75f, last})
    for (const float y : {0.f, 1e-30f, 0.25f, 0.5f, 0.75f, last}) {
      const Vec2f u{x, y}, disk = sample_disk(u), triangle = sample_triangle(u);
      EXPECT_LE(disk.x * disk.x + disk.y * disk.y, 1 + 1e-6f);
      EXPECT_GE(triangle.x, 0);
      EXPECT_GE(triangle.y, 0);
      EXPECT_LE(triangle.x + triangle.y, 1);
      EXPECT_GE(sample_cosine_hemisphere(u).z, 0);
      EXPECT_NEAR(length(sample_cosine_hemisphere(u)), 1, 1e-6);
      EXPECT_NEAR(length(sample_sphere(u)), 1, 1e-6);
    }
  EXPECT_EQ(sample_disk({0.5f, 0.5f}), Vec2f(0, 0));
}

TEST(Warp, DiskIsContinuousAcrossItsWedges) {
  // Neighbours in the square stay neighbors: the concentric map stretches lengths by at most pi / 2 of the
  // scale 2.
  constexpr int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec2f here = sample_disk({float(i) / n, float(j) / n});
      EXPECT_LT((sample_disk({float(i + 1) / n, float(j) / n}) - here).length(), 4.f / n);
      EXPECT_LT((sample_disk({float(i) / n, float(j + 1) / n}) - here).length(), 4.f / n);
    }
}

TEST(Warp, TriangleInverts) {
  test::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec2f u = random.next2(), back = invert_sample_triangle(sample_triangle(u));
    ASSERT_NEAR(back.x, u.x, 1e-6);
    ASSERT_NEAR(back.y, u.y, 1e-6);
  }
}

}  // namespace
}  // namespace vernier
