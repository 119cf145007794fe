// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/agreement.h"
#include "apps/validation/leaks.h"
#include "scene/accel/bvh.h"
#include "tests/scene/accel_support.h"
#include "tests/support/effort.h"

// Rates of 1e-5 are seen with 95 % confidence (rule of three); `vernier bench stability` runs the same with
// 10^7 rays.

namespace vernier {
namespace {

using namespace validation;
using test::EveryAccelerator;

constexpr uint64_t rays = 300'000 / test::thinning;
constexpr float distances[] = {1, 100, 1e4f};

class Watertightness : public EveryAccelerator {};

/// No leaks where the table claims so, and some where it does not: a claim that is too modest is wrong too.
void expect_claim(bool claimed, const Count& leaks) {
  testing::Test::RecordProperty("leaks_per_million", static_cast<int>(leaks.per_million()));
  if (claimed)
    EXPECT_EQ(leaks.events, 0u);
  else
    EXPECT_GT(leaks.events, 0u);
}

TEST_P(Watertightness, IsAsClaimedAtEdges) {
  Count leaks;
  for (const float distance : distances)
    leaks += leaks_at_edges(GetParam().build, {distance, 1, {0, 0, 0}}, rays / 3, 1);
  leaks += leaks_at_edges(GetParam().build, {10, 1, {500, -700, 300}}, rays / 10, 2);
  leaks += leaks_at_edges(GetParam().build, {10, 1e6f, {0, 0, 0}}, rays / 10, 3);
  expect_claim(GetParam().watertight >= Watertight::at_edges, leaks);
}

TEST_P(Watertightness, IsAsClaimedAtVertices) {
  Count leaks;
  for (const float distance : distances)
    leaks += leaks_at_vertices(GetParam().build, {distance, 1, {0, 0, 0}}, rays / 3, 4);
  leaks += leaks_at_vertices(GetParam().build, {10, 1, {500, -700, 300}}, rays / 10, 5);
  leaks += leaks_at_vertices(GetParam().build, {10, 1e6f, {0, 0, 0}}, rays / 10, 6);
  expect_claim(GetParam().watertight >= Watertight::at_edges_and_vertices, leaks);
}

TEST_P(Watertightness, IsAsClaimedAllAroundAClosedSurface) {
  const uint64_t count = GetParam().name == "brute_force" ? rays / 300 : rays;
  expect_claim(GetParam().watertight >= Watertight::at_edges_and_vertices,
               leaks_of_closed_surface(GetParam().build, count, 7));
}

INSTANTIATE_TEST_SUITE_P(Accelerators, Watertightness, testing::ValuesIn(accelerators()),
                         test::accelerator_test_name);

class Agreement : public EveryAccelerator {};

// The tests above would pass an accelerator that always hits, so: what is missed must be missed.
TEST_P(Agreement, DoesNotHitBesideTriangles) {
  const float tolerance = 1e-3f;
  validation::TriangleSoup soup;
  soup.add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const auto accelerator = build(soup);
  for (const Vec3f& outside :
       {Vec3f{-tolerance, .5f, 0}, Vec3f{.5f, -tolerance, 0}, Vec3f{.5f + tolerance, .5f, 0}}) {
    EXPECT_FALSE(accelerator->closest(test::make_ray(outside + Vec3f{1, 2, 3}, {-1, -2, -3})));
    EXPECT_FALSE(accelerator->occluded(test::make_ray(outside + Vec3f{1, 2, 3}, {-1, -2, -3})));
  }
}

TEST_P(Agreement, AgreesWithTheReference) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    Rng rng(seed, 0);
    TriangleSoup soup;
    add_random_triangles(soup, rng, 300, rng.magnitude(.03f, .5f));
    add_waves(soup, 12);
    add_blob(soup, rng, 2, .5f, rng.in_cube(.5f));
    const uint64_t count = GetParam().name == "brute_force" ? 10'000 : 250'000;
    const auto result = compare(*build(soup), *build_bvh(soup.geometry()), soup, count, seed);
    EXPECT_EQ(result.real, 0u) << "of " << result.rays;
    EXPECT_LT(result.within_rounding, result.rays / 4);
  }
}

FOR_EVERY_ACCELERATOR(Agreement);

// Mutations: tests that leak must be found out.
TEST(WatertightnessChecks, CatchTheTestOfMoellerAndTrumbore) {
  EXPECT_GT(leaks_at_edges(build_bvh_moeller, {1, 1, {0, 0, 0}}, 10'000, 1).per_million(), 10'000);
  EXPECT_GT(leaks_at_vertices(build_bvh_moeller, {1, 1, {0, 0, 0}}, 10'000, 1).per_million(), 10'000);
  EXPECT_GT(leaks_of_closed_surface(build_bvh_moeller, 10'000, 1).per_million(), 10'000);
}

TEST(WatertightnessChecks, CatchParityErrors) {
  // Both triangles of an edge count, here as in Embree: crossings of edges do not pair up.
  EXPECT_GT(parity_errors(build_bvh, 10'000, 1).events, 0u);
}

}  // namespace
}  // namespace vernier
