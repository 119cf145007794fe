// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "apps/validation/exact.h"
#include "apps/validation/soup.h"
#include "core/math/frame.h"
#include "core/sampling/warp.h"
#include "scene/accel/triangle_block.h"
#include "scene/accel/triangle_set.h"
#include "tests/support/effort.h"

namespace vernier {
namespace {

using validation::Corners;
using validation::distance_to_boundary;
using validation::ExactHit;
using validation::intersect_exactly;
using validation::is_near_boundary;
using validation::Rng;
using Kind = ExactHit::Kind;

const Corners unit_triangle{Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}};

Ray ray_down(float x, float y) {
  Ray ray;
  ray.origin = {x, y, 2};
  ray.direction = {0, 0, -1};
  return ray;
}

TEST(ExactIntersection, TellsInsideFromBoundaryToTheLastBit) {
  const float below_one = std::nextafter(0.5f, 0.f), above = std::nextafter(0.5f, 1.f);
  EXPECT_EQ(intersect_exactly(ray_down(0.5f, below_one), unit_triangle).kind, Kind::hit);
  EXPECT_EQ(intersect_exactly(ray_down(0.5f, 0.5f), unit_triangle).kind, Kind::boundary);
  EXPECT_EQ(intersect_exactly(ray_down(0.5f, above), unit_triangle).kind, Kind::miss);
  EXPECT_EQ(intersect_exactly(ray_down(0, 0), unit_triangle).kind, Kind::boundary);
}

TEST(ExactIntersection, GivesParametersAndBarycentricsOfTheSecondAndThirdVertex) {
  const ExactHit hit = intersect_exactly(ray_down(0.25f, 0.5f), unit_triangle);
  EXPECT_EQ(hit.t, 2);
  EXPECT_EQ(hit.u, 0.25);
  EXPECT_EQ(hit.v, 0.5);
}

TEST(ExactIntersection, CallsRaysInThePlaneAndTrianglesWithoutAreaCoplanar) {
  Ray ray;
  ray.origin = {-1, 0.5f, 0};
  ray.direction = {1, 0, 0};
  EXPECT_EQ(intersect_exactly(ray, unit_triangle).kind, Kind::coplanar);
  const Corners line{Vec3f{0, 0, 0}, Vec3f{1, 2, 3}, Vec3f{2, 4, 6}};
  EXPECT_EQ(intersect_exactly(ray_down(1, 2), line).kind, Kind::coplanar);
}

TEST(ExactIntersection, MeasuresTheDistanceToTheNearestEdge) {
  EXPECT_DOUBLE_EQ(distance_to_boundary(ray_down(0.25f, 0.125f), unit_triangle), 0.125);
  EXPECT_DOUBLE_EQ(distance_to_boundary(ray_down(-3, -4), unit_triangle), 5);
  EXPECT_TRUE(is_near_boundary(ray_down(0.25f, 1e-7f), unit_triangle));
  EXPECT_FALSE(is_near_boundary(ray_down(0.25f, 1e-5f), unit_triangle));
}

/// A random ray and triangle; the ray often through an edge, a vertex or along an axis.
std::pair<Ray, Corners> random_case(Rng& rng) {
  Corners c;
  for (Vec3f& corner : c) corner = rng.in_cube(1);
  Vec3f target = c[0] + (c[1] - c[0]) * rng.uniform(-.2f, 1) + (c[2] - c[0]) * rng.uniform(-.2f, 1);
  if (rng.below(3) == 0) target = c[0] + (c[1] - c[0]) * rng.uniform(0, 1);
  if (rng.below(6) == 0) target = c[1];
  Ray ray;
  ray.origin = target + rng.direction() * rng.magnitude(.1f, 1000);
  ray.direction = target - ray.origin;
  if (rng.below(6) == 0) {
    ray.origin = target;
    ray.origin.z += 3;
    ray.direction = {0, -0.f, -1};
  }
  return {ray, c};
}

TEST(TriangleTests, AgreeWithExactArithmetic) {
  Rng rng(1, 0);
  int hits = 0;
  constexpr int cases = 200'000 / test::thinning;
  for (int i = 0; i < cases; ++i) {
    const auto [ray, c] = random_case(rng);
    const ExactHit exact = intersect_exactly(ray, c);
    const bool is_hit = exact.kind == Kind::hit && exact.t > 0;
    for (const auto& hit : {intersect_watertight(ShearedRay(ray.origin, ray.direction), c[0], c[1], c[2]),
                            intersect_moeller_trumbore(ray, c[0], c[1], c[2])}) {
      const bool found = hit && hit->t > 0;
      ASSERT_TRUE(found == is_hit || is_near_boundary(ray, c)) << i;
      if (!found || !is_hit) continue;
      ++hits;
      ASSERT_LE(std::abs(hit->t - exact.t), exact.t_bound) << i;
      ASSERT_LE(std::abs(hit->u - exact.u), exact.u_bound) << i;
      ASSERT_LE(std::abs(hit->v - exact.v), exact.v_bound) << i;
    }
  }
  EXPECT_GT(hits, cases / 2);
}

// Needles 4 m long and half a millimetre wide, met at a hundredth of a radian from a millimetre above: the
// distances of their corners are thousands of times that of the hit.
TEST(TriangleTests, NeedlesAreMetWhereTheyAre) {
  Rng rng(7, 0);
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3f along = sample_sphere({rng.uniform(0, 1), rng.uniform(0, 1)});
    const auto [across, up, unused] = Frame::from_normal(along);
    const Vec3f corner(rng.uniform(0, 1) - 2, rng.uniform(0, 1), rng.uniform(0, 1) - 1);
    const Corners c{corner, corner + along * 4, corner + along * (4 * rng.uniform(0, 1)) + across * 5e-4f};
    const float v = 0.25f + rng.uniform(0, 1) / 2, u = (1 - v) * rng.uniform(0, 1);
    const Vec3f on = c[0] * (1 - u - v) + c[1] * u + c[2] * v;
    Ray ray;
    ray.origin = on - (along + across) * 0.07f + up * 1e-3f;
    ray.direction = on - ray.origin;
    const ExactHit exact = intersect_exactly(ray, c);
    if (exact.kind != Kind::hit || is_near_boundary(ray, c)) continue;
    const auto hit = intersect_watertight(ShearedRay(ray.origin, ray.direction), c[0], c[1], c[2]);
    ASSERT_TRUE(hit) << i;
    ASSERT_NEAR(hit->t, exact.t, 1e-3) << i;
    ++hits;
  }
  EXPECT_GT(hits, 10'000);
}

/// The block's answer for its one triangle in each lane against the plain function's, to the bit.
template <typename Test, typename Plain>
void expect_same_bits(const Plain& plain) {
  Rng rng(2, 0);
  for (int i = 0; i < 50'000; ++i) {
    const auto [ray, c] = random_case(rng);
    std::array<Corners, 4> lanes{c, c, c, c};
    for (Corners& lane : lanes) std::rotate(lane.begin(), lane.begin() + rng.below(3), lane.end());
    TriangleBlock block{};
    for (unsigned lane = 0; lane < 4; ++lane)
      for (int vertex = 0; vertex < 3; ++vertex)
        for (int axis = 0; axis < 3; ++axis)
          block.vertex[vertex][axis][lane] = lanes[lane][static_cast<size_t>(vertex)][axis];
    BlockHits hits;
    const float far = std::numeric_limits<float>::max();
    const unsigned found = Test::test(block, typename Test::Ray(ray.origin, ray.direction), 0, far, hits);
    for (unsigned lane = 0; lane < 4; ++lane) {
      const auto hit = plain(ray, lanes[lane]);
      const bool expected = hit && hit->t > 0;
      ASSERT_EQ(expected, bool(found >> lane & 1)) << i;
      if (!expected) continue;
      ASSERT_EQ(hit->t, hits.t[lane]) << i;
      ASSERT_EQ(hit->u, hits.u[lane]) << i;
      ASSERT_EQ(hit->v, hits.v[lane]) << i;
    }
  }
}

TEST(TriangleTests, GiveTheSameBitsFourAtATime) {
  expect_same_bits<WatertightTest>([](const Ray& ray, const Corners& c) {
    return intersect_watertight(ShearedRay(ray.origin, ray.direction), c[0], c[1], c[2]);
  });
  expect_same_bits<MoellerTrumboreTest>(
      [](const Ray& ray, const Corners& c) { return intersect_moeller_trumbore(ray, c[0], c[1], c[2]); });
}

TEST(TriangleTests, CallTrianglesWithoutAreaOrWithNonFiniteVerticesUnhittable) {
  const Vec3f a{0, 0, 0}, b{1, 2, 3}, c{2, 4, 6}, d{0, 1, 0};
  EXPECT_TRUE(is_hittable(a, b, d));
  EXPECT_FALSE(is_hittable(a, b, c));
  EXPECT_FALSE(is_hittable(a, a, d));
  EXPECT_FALSE(is_hittable(a, b, {0, std::numeric_limits<float>::quiet_NaN(), 0}));
  EXPECT_FALSE(is_hittable(a, b, {0, std::numeric_limits<float>::infinity(), 0}));
}

}  // namespace
}  // namespace vernier
