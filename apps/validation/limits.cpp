// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/limits.h"

#include <chrono>
#include <cmath>
#include <limits>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace vernier::validation {
namespace {

constexpr uint64_t rays_a_portion = 1000;
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Lets this thread take denormal numbers for zero, on the processors that can.
class FlushDenormals {
 public:
  explicit FlushDenormals(bool flush) {
#ifdef __SSE2__
    if (flush) _mm_setcsr(saved_ | 0x8040);  // flush to zero, denormals are zero
#else
    (void)flush;
#endif
  }
  ~FlushDenormals() {
#ifdef __SSE2__
    _mm_setcsr(saved_);
#endif
  }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#ifdef __SSE2__
  unsigned saved_ = _mm_getcsr();
#endif
};

bool is_hit_at_size(BuildAccelerator build, float size, bool flush_denormals) {
  TriangleSoup soup;
  soup.add({{0, 0, 0}, {size, 0, 0}, {0, size, 0}}, {{0, 1, 2}});
  const auto accelerator = build(soup.geometry());
  const FlushDenormals flush(flush_denormals);
  Ray ray;
  ray.origin = {.25f * size, .25f * size, size};
  ray.direction = {0, 0, -1};
  const auto hit = accelerator->closest(ray);
  const auto near = [](float a, float b) { return std::abs(a - b) <= 1e-5f * std::abs(b); };
  return hit && near(hit->t, size) && near(hit->u, .25f) && near(hit->v, .25f);
}

/// Which of the components a ray has that makes it invalid is random.
Ray invalid_ray(Rng& rng) {
  constexpr float bad[] = {nan, infinity, -infinity};
  Ray ray;
  ray.origin = rng.in_cube(1);
  ray.direction = rng.direction();
  const uint32_t what = rng.below(7);
  if (what == 6)
    ray.direction = {0, rng.below(2) ? 0.f : -0.f, 0};
  else
    (what < 3 ? ray.origin : ray.direction)[static_cast<int>(what % 3)] = bad[rng.below(3)];
  return ray;
}

/// Triangles none of which can be hit, and one in the plane y = 2 that can.
void add_degenerate_triangles(TriangleSoup& soup, Rng& rng) {
  std::vector<Vec3f> positions{{-1, 2, -1}, {1, 2, -1}, {0, 2, 1}};
  std::vector<Triangle> triangles{{0, 1, 2}};
  const auto add = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const auto first = static_cast<uint32_t>(positions.size());
    positions.insert(positions.end(), {a, b, c});
    triangles.push_back({first, first + 1, first + 2});
  };
  for (int i = 0; i < 20; ++i) {
    const Vec3f a = rng.in_cube(1), b = rng.in_cube(1);
    add(a, a, b);
    add(a, a, a);
    add(a, {nan, 0, 0}, b);
    add(a, b, {0, infinity, 0});
    const Vec3f step{std::round(b.x * 64) / 64, std::round(b.y * 64) / 64, std::round(b.z * 64) / 64};
    add({0, 0, 0}, step, step * 2.f);  // collinear exactly
  }
  soup.add(std::move(positions), std::move(triangles));
}

}  // namespace

SizeRange sizes_hit(BuildAccelerator build, bool flush_denormals) {
  const auto hit = [&](int exponent) {
    return is_hit_at_size(build, std::pow(10.f, float(exponent)), flush_denormals);
  };
  if (!hit(0)) return {};
  int low = 0, high = 0;
  while (low > -45 && hit(low - 1)) --low;
  while (high < 38 && hit(high + 1)) ++high;
  return {std::pow(10., low), std::pow(10., high)};
}

Count phantom_hits(BuildAccelerator build, uint64_t rays, uint64_t seed) {
  TriangleSoup soup;
  Rng shape(seed, ~uint64_t{0});
  add_degenerate_triangles(soup, shape);
  const auto accelerator = build(soup.geometry());
  return count_portions(rays, rays_a_portion, seed, [&](Rng& rng, uint64_t count) {
    Count phantoms{0, count};
    for (uint64_t i = 0; i < count; ++i) {
      Ray ray = invalid_ray(rng);
      const uint32_t kind = rng.below(3);
      if (kind == 0) {  // at a vertex of the degenerate triangles; the sound one is behind the origin
        const auto& positions = soup.geometry().meshes[0].positions;
        ray.origin = rng.in_cube(1.5f);
        ray.direction = positions[3 + rng.below(static_cast<uint32_t>(positions.size()) - 3)] - ray.origin;
        if (ray.direction.y > 0) continue;
      } else if (kind == 1) {  // in the plane of the sound one
        ray.origin = {-3, 2, rng.uniform(-1, 1)};
        ray.direction = {1, 0, rng.uniform(-.5f, .5f)};
      }
      phantoms.events += accelerator->closest(ray).has_value() || accelerator->occluded(ray);
    }
    return phantoms;
  });
}

Count interval_errors(BuildAccelerator build, uint64_t rays, uint64_t seed) {
  return count_portions(rays, rays_a_portion, seed, [&](Rng& rng, uint64_t count) {
    TriangleSoup soup;
    add_random_triangles(soup, rng, 1, 1);
    const auto accelerator = build(soup.geometry());
    const Corners c = soup.corners(0, 0);
    std::vector<RawHit> hits;
    Count errors{0, count};
    for (uint64_t i = 0; i < count; ++i) {
      Ray ray;
      ray.origin = rng.in_cube(3);
      ray.direction = (c[0] + c[1] + c[2]) / 3 - ray.origin;
      const auto hit = accelerator->closest(ray);
      if (!hit) continue;  // grazing
      const float t = hit->t, before = std::nextafter(t, 0.f), behind = std::nextafter(t, infinity);
      const struct {
        float t_min, t_max;
        bool is_hit;
      } intervals[] = {
          {0, t, false},          {0, behind, true},    {t, infinity, false}, {before, infinity, true},
          {before, behind, true}, {-1, infinity, true}, {0, 0, false},        {2 * t, t, false},
          {nan, infinity, false}, {0, nan, false},      {-2, -1, false}};
      for (const auto& [t_min, t_max, is_hit] : intervals) {
        ray.t_min = t_min;
        ray.t_max = t_max;
        accelerator->all_hits(ray, hits);
        if (accelerator->closest(ray).has_value() == is_hit && accelerator->occluded(ray) == is_hit &&
            hits.empty() != is_hit)
          continue;
        ++errors.events;
        break;
      }
    }
    return errors;
  });
}

double invalid_ray_cost(BuildAccelerator build, uint64_t rays, uint64_t seed) {
  TriangleSoup soup;
  add_waves(soup, 100);
  const auto accelerator = build(soup.geometry());
  const auto seconds = [&](const auto& make_ray) {
    Rng rng(seed, 0);
    std::vector<Ray> all;
    for (uint64_t i = 0; i < rays; ++i) all.push_back(make_ray(rng));
    const auto start = std::chrono::steady_clock::now();
    for (const Ray& ray : all) accelerator->closest(ray);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const double valid = seconds([](Rng& rng) {
    Ray ray;
    ray.origin = rng.in_cube(1);
    ray.direction = rng.direction();
    return ray;
  });
  return seconds(invalid_ray) / valid;
}

}  // namespace vernier::validation
