// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/structure.h"

#include <array>
#include <cmath>

namespace vernier::validation {
namespace {

void same_centroid(TriangleSoup& soup, uint32_t count) {
  Rng rng(1, 0);
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3f a = rng.direction(), b = rng.direction();
    positions.insert(positions.end(), {a, b, -(a + b)});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  soup.add(std::move(positions), std::move(triangles));
}

void copies_of_one_triangle(TriangleSoup& soup, uint32_t count) {
  soup.add({{-1, -1, 0}, {1, -1, .5f}, {0, 1, 0}}, std::vector<Triangle>(count, Triangle{0, 1, 2}));
}

void long_diagonals(TriangleSoup& soup, uint32_t count) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  const float step = 2 / float(count);
  for (uint32_t i = 0; i < count; ++i) {
    const float x = float(i) * step;
    positions.insert(positions.end(), {{x - 1, -1, -1}, {x - 1 + step, -1, -1}, {1, 1, 1}});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  soup.add(std::move(positions), std::move(triangles));
}

void exponential_spacing(TriangleSoup& soup, uint32_t count) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (uint32_t i = 0; i < count; ++i) {
    const float x = std::ldexp(1.f, 1 - static_cast<int>(i));
    positions.insert(positions.end(), {{x, 0, 0}, {1.25f * x, 0, 0}, {x, .25f * x, .125f * x}});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  soup.add(std::move(positions), std::move(triangles));
}

void tiny_in_huge(TriangleSoup& soup, uint32_t) {
  Rng rng(2, 0);
  add_blob(soup, rng, 1, 1e6f, {0, 0, 0});
  add_blob(soup, rng, 2, 1e-3f, {.5f, .5f, .5f});
}

/// Squares along each side of a wavy mesh of about so many triangles.
unsigned side_of(uint64_t triangles) {
  return std::max(1u, static_cast<unsigned>(std::lround(std::sqrt(double(triangles) / 2))));
}

}  // namespace

std::span<const Stress> stresses() {
  static constexpr std::array table{Stress{"SameCentroid", same_centroid, 1, 100'000},
                                    Stress{"CopiesOfOneTriangle", copies_of_one_triangle, 1, 100'000},
                                    Stress{"LongDiagonals", long_diagonals, 1, 100'000},
                                    Stress{"ExponentialSpacing", exponential_spacing, 4, 125},
                                    Stress{"OneTriangle", copies_of_one_triangle, 1, 1},
                                    Stress{"TinyInHuge", tiny_in_huge, 1e6f, 400}};
  return table;
}

double build_cost(BuildAccelerator build, const Stress& stress) {
  TriangleSoup hard, plain;
  stress.fill(hard, stress.triangles);
  add_waves(plain, side_of(stress.triangles));
  // The first build of all wakes the threads up, and the faster of two is the less disturbed.
  const auto seconds = [&](const TriangleSoup& soup) {
    const double first = build(soup.geometry())->stats().build_seconds;
    return std::min(first, build(soup.geometry())->stats().build_seconds);
  };
  const double regular = seconds(plain);
  return seconds(hard) / regular;
}

Count wrong_in_large_mesh(BuildAccelerator build, uint64_t triangles, uint64_t rays, uint64_t seed) {
  TriangleSoup soup;
  add_waves(soup, side_of(triangles));
  const auto accelerator = build(soup.geometry());
  const auto count_triangles = static_cast<uint32_t>(soup.geometry().meshes[0].triangles.size());
  return count_portions(rays, 1000, seed, [&](Rng& rng, uint64_t count) {
    Count wrong{0, count};
    for (uint64_t i = 0; i < count; ++i) {
      const uint32_t triangle = rng.below(count_triangles);
      const Corners c = soup.corners(0, triangle);
      const float u = rng.uniform(.2f, .4f), v = rng.uniform(.2f, .4f);
      const Vec3f target = c[0] + (c[1] - c[0]) * u + (c[2] - c[0]) * v;
      // The waves' slope is below one, so a ray this steep meets them once.
      const Vec3f away{rng.uniform(-.3f, .3f), rng.uniform(-.3f, .3f), 1};
      Ray ray;
      ray.origin = target + away;
      ray.direction = target - ray.origin;
      const auto hit = accelerator->closest(ray);
      wrong.events += !hit || hit->primitive != triangle;
    }
    return wrong;
  });
}

}  // namespace vernier::validation
