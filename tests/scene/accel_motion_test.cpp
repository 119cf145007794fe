// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/agreement.h"
#include "core/math/moments.h"
#include "scene/accel/brute_force.h"
#include "scene/accel/query.h"
#include "tests/scene/accel_support.h"

// Triangles that move: at every time accelerators must answer as others do for triangles that stand still
// where these are then.

namespace vernier::test {
namespace {

using validation::Rng;
using validation::TriangleSoup;

class MovingTriangles : public EveryAccelerator {};

/// Random triangles that are elsewhere at each moment.
std::vector<std::vector<Vec3f>> random_moments(Rng& rng, size_t moments, uint32_t triangles) {
  std::vector<std::vector<Vec3f>> all(moments);
  for (uint32_t i = 0; i < triangles; ++i) {
    const Vec3f center = rng.in_cube(1), speed = rng.in_cube(0.4f);
    for (size_t m = 0; m < moments; ++m)
      for (int corner = 0; corner < 3; ++corner)
        all[m].push_back(center + speed * (float(m) / float(moments - 1)) + rng.in_cube(0.2f));
  }
  return all;
}

std::vector<Triangle> separate_triangles(uint32_t count) {
  std::vector<Triangle> triangles;
  for (uint32_t i = 0; i < count; ++i) triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  return triangles;
}

/// Meshes known at 2, 3, 5 and 33 moments, one that stands still in the world, and one placed in it.
class MovingSoup {
 public:
  explicit MovingSoup(Rng& rng) {
    for (const size_t moments : {2, 3, 5, 5, 33}) {
      const uint32_t count = 40 + rng.below(20);
      moments_.push_back(random_moments(rng, moments, count));
      soup.add_moving(moments_.back(), separate_triangles(count));
    }
    still_ = random_moments(rng, 2, 50)[0];
    placement_ = validation::random_placement(rng, {1, 0.5f, -1}, {0.1f, 0, 0});
    add_still(soup);
  }

  /// What stands where this is at a time.
  void freeze(float time, TriangleSoup& frozen) const {
    for (const auto& moments : moments_) {
      const auto [first, part] = moments_around(time, moments.size());
      std::vector<Vec3f> positions;
      for (size_t i = 0; i < moments[0].size(); ++i)
        positions.push_back(between(moments[first][i], moments[first + 1][i], part));
      const auto count = uint32_t(positions.size() / 3);
      frozen.add(std::move(positions), separate_triangles(count));
    }
    add_still(frozen);
  }

  TriangleSoup soup;

 private:
  void add_still(TriangleSoup& to) const {
    to.add(still_, separate_triangles(50));
    const uint32_t mesh = to.add_mesh(still_, separate_triangles(50));
    to.add_instance(mesh, placement_);
    to.add_instance(mesh, {.origin = {0.3f, 0.2f, 0.1f}});
  }

  std::vector<std::vector<std::vector<Vec3f>>> moments_;
  std::vector<Vec3f> still_;
  Transform placement_;
};

Ray random_ray(Rng& rng, float time) {
  const Vec3f from = rng.in_cube(2.5f), toward = rng.in_cube(1);
  Ray ray = make_ray(from, toward - from);
  ray.time = time;
  return ray;
}

/// Embree rounds its own way: it may miss at edges what others hit, and finds t to a few bits.
bool agree(const std::optional<RawHit>& a, const std::optional<RawHit>& b) {
  if (!a || !b) return !a && !b;
  return a->instance == b->instance && a->primitive == b->primitive && std::abs(a->t - b->t) <= 1e-5f * b->t;
}

TEST_P(MovingTriangles, AreHitWhereTheyAreAtTheRaysTime) {
  Rng rng(7, 1);
  const MovingSoup moving(rng);
  const auto accelerator = build(moving.soup);
  const bool rounds_alike = GetParam().name.find("embree") == std::string_view::npos &&
                            GetParam().name.find("moeller") == std::string_view::npos;
  constexpr int rays = 500;
  size_t hits = 0, different = 0;
  for (const float time : {0.f, 1e-6f, 0.2f, 0.25f, 0.499999f, 0.5f, 0.71f, 0.99999f, 1.f}) {
    TriangleSoup frozen;
    moving.freeze(time, frozen);
    const auto reference = build_brute_force(frozen.geometry());
    for (int i = 0; i < rays; ++i) {
      const Ray ray = random_ray(rng, time);
      const auto expected = reference->closest(ray), found = accelerator->closest(ray);
      hits += expected.has_value();
      different += rounds_alike ? !same_bits(expected, found) : !agree(expected, found);
      different += accelerator->occluded(ray) != expected.has_value();
      std::vector<RawHit> all, expected_all;
      accelerator->all_hits(ray, all);
      reference->all_hits(ray, expected_all);
      different += all.size() != expected_all.size();
    }
  }
  EXPECT_GT(hits, 1000u);
  EXPECT_LE(different, rounds_alike ? 0u : 3u) << "of " << 9 * rays;
}

TEST_P(MovingTriangles, WithoutAreaAtAllMomentsOrNotFiniteAreNeverHit) {
  TriangleSoup soup;
  const std::vector<Vec3f> line{{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  soup.add_moving({line, line, line}, {{0, 1, 2}});
  const std::vector<Vec3f> whole{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  soup.add_moving({whole, {{-1, -1, 0}, {1, -1, 0}, {0, nan, 0}}}, {{0, 1, 2}});
  const auto accelerator = build(soup);
  for (const float time : {0.f, 0.3f, 0.5f, 1.f}) {
    Ray ray = make_ray({0, 0, 5}, {0, 0, -1});
    ray.time = time;
    EXPECT_FALSE(accelerator->closest(ray)) << time;
    EXPECT_FALSE(accelerator->occluded(ray)) << time;
  }
}

TEST_P(MovingTriangles, ThatARayLeavesOrReachesLetItPass) {
  TriangleSoup soup;
  const std::vector<Vec3f> before{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}},
      after{{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}};
  soup.add_moving({before, after}, {{0, 1, 2}});
  const auto accelerator = build(soup);
  Ray ray = make_ray({0, 0, 5}, {0, 0, -1});
  ray.time = 0.25f;
  const auto hit = accelerator->closest(ray);
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit->t, 4.75f);
  ray.origin_triangle = {0, 0};
  EXPECT_FALSE(accelerator->closest(ray));
  EXPECT_FALSE(accelerator->occluded(ray));
}

FOR_EVERY_ACCELERATOR(MovingTriangles);

}  // namespace
}  // namespace vernier::test
