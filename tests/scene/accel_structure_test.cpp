// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/agreement.h"
#include "apps/validation/structure.h"
#include "core/base/names.h"
#include "core/base/parallel.h"
#include "scene/accel/brute_force.h"
#include "scene/accel/bvh.h"
#include "scene/accel/octree.h"
#include "tests/scene/accel_support.h"
#include "tests/support/effort.h"

namespace vernier {
namespace {

using namespace validation;
using test::EveryAccelerator;
using test::make_ray;
using test::same_bits;

/// Random rays in and around [-1, 1]^3 times `size` have the same answers, to the bit, as the reference's
/// brute force.
void expect_brute_force_answers(const Accelerator& accelerator, const TriangleSoup& soup, float size,
                                int rays) {
  const auto truth = build_brute_force(soup.geometry());
  Rng rng(11, 0);
  std::vector<RawHit> expected, found;
  for (int i = 0; i < rays; ++i) {
    const Ray ray = make_ray(rng.in_cube(1.5f * size), rng.direction());
    ASSERT_TRUE(same_bits(accelerator.closest(ray), truth->closest(ray))) << i;
    ASSERT_EQ(accelerator.occluded(ray), truth->occluded(ray)) << i;
    truth->all_hits(ray, expected);
    accelerator.all_hits(ray, found);
    ASSERT_TRUE(std::ranges::equal(found, expected, [](const RawHit& a, const RawHit& b) {
      return same_bits(a, b);
    })) << i;
  }
}

TEST(OwnAccelerators, AnswerAlikeToTheBit) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed, 0);
    TriangleSoup soup;
    add_random_triangles(soup, rng, 1 + rng.below(300), rng.magnitude(.01f, 1));
    add_waves(soup, 6);
    const uint32_t mesh = rng.below(2);
    for (int i = 0; i < 5; ++i) {
      const Vec3f stretch{rng.magnitude(.1f, 10), rng.magnitude(.1f, 10), i == 4 ? 0.f : rng.uniform(-1, 1)};
      soup.add_instance(mesh, random_placement(rng, stretch, rng.in_cube(3)));
    }
    for (const auto build : {build_bvh, build_octree})
      expect_brute_force_answers(*build(soup.geometry()), soup, 2, 1000 / test::thinning);
  }
}

/// Enough triangles to hurt a bad builder, few enough for brute force.
uint32_t test_size(const Stress& stress) { return std::min(stress.triangles, 20'000u / test::thinning); }

class StructureStress : public testing::TestWithParam<Stress> {};

TEST_P(StructureStress, ChangesNoAnswer) {
  TriangleSoup soup;
  GetParam().fill(soup, test_size(GetParam()));
  for (const auto build : {build_bvh, build_octree})
    expect_brute_force_answers(*build(soup.geometry()), soup, GetParam().size, 300);
}

TEST_P(StructureStress, IsHeldByEveryAccelerator) {
  for (const auto& entry : accelerators()) {
    TriangleSoup soup;
    GetParam().fill(soup, test_size(GetParam()));
    const auto reference = build_bvh(soup.geometry()), accelerator = entry.build(soup.geometry());
    Rng rng(12, 0);
    int misses = 0;
    for (int i = 0; i < 300; ++i) {
      const Ray ray = make_ray(rng.in_cube(1.5f * GetParam().size), rng.direction());
      misses += accelerator->closest(ray).has_value() != reference->closest(ray).has_value();
    }
    EXPECT_LE(misses, 3) << entry.name;  // grazing slivers
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, StructureStress, testing::ValuesIn(stresses()),
                         [](const auto& stress) { return std::string(stress.param.name); });

TEST(Bvh, StaysShallowWhereEverySplitPeelsOneTriangle) {
  TriangleSoup soup;
  const Stress& exponential = find_by_name(stresses(), "stress", "ExponentialSpacing");
  exponential.fill(soup, exponential.triangles);
  const Bvh bvh(soup.geometry());
  const auto cost = bvh.closest_cost(make_ray({-1, .01f, .005f}, {1, 1e-5f, 1e-5f}));
  ASSERT_TRUE(cost);
  EXPECT_LE(cost->nodes, 100u);
}

TEST(Bvh, IsTheSameHoweverManyThreadsBuildIt) {
  const auto cost_of = [](unsigned threads) {
    const ThreadLimit limit(threads);
    TriangleSoup soup;
    add_waves(soup, 150);
    const Bvh bvh(soup.geometry());
    Rng rng(5, 0);
    QueryCost sum;
    for (int i = 0; i < 2000; ++i) {
      const auto cost = bvh.closest_cost(make_ray(rng.in_cube(2), rng.direction()));
      sum.nodes += cost->nodes;
      sum.blocks += cost->blocks;
    }
    return std::pair(sum.nodes, sum.blocks);
  };
  EXPECT_EQ(cost_of(1), cost_of(0));
}

TEST(Bvh, AnswersRightAfterVerticesMoved) {
  Rng rng(6, 0);
  TriangleSoup soup;
  add_random_triangles(soup, rng, 500, .2f);
  soup.add_instance(0, random_placement(rng, {1, 2, 3}, {4, 0, 0}));
  soup.add_instance(0, random_placement(rng, {1, 1, 0}, {-4, 0, 0}));
  Bvh bvh(soup.geometry());
  for (int step = 0; step < 3; ++step) {
    for (Vec3f& p : soup.positions(0)) p += rng.in_cube(.5f);
    bvh.refit();
    expect_brute_force_answers(bvh, soup, 3, 1000);
  }
}

class LargeMeshes : public EveryAccelerator {};

TEST_P(LargeMeshes, FindsEveryTriangleOfALargeMesh) {
  if (GetParam().name == "brute_force") GTEST_SKIP() << "too slow";
  TriangleSoup soup;
  add_waves(soup, 220);  // 96,800 triangles
  const auto accelerator = build(soup);
  const auto& mesh = soup.geometry().meshes[0];
  for (uint32_t i = 0; i < mesh.triangles.size(); i += 7) {
    const Corners c = soup.corners(0, i);
    const Vec3f middle = (c[0] + c[1] + c[2]) / 3;
    const auto hit = accelerator->closest(make_ray(middle + Vec3f{.001f, .002f, 1}, {-.001f, -.002f, -1}));
    ASSERT_TRUE(hit) << i;
    EXPECT_EQ(hit->primitive, i);
  }
  EXPECT_GT(accelerator->stats().bytes, mesh.triangles.size() * 10);
}

TEST_P(LargeMeshes, PicksTheSameOfCoincidingTrianglesAfterARebuild) {
  Rng rng(7, 0);
  TriangleSoup soup;
  for (int i = 0; i < 3; ++i) {
    Rng same(8, 0);
    add_random_triangles(soup, same, 200, .4f);
  }
  const auto first = build(soup), second = build(soup);
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = make_ray(rng.in_cube(2), rng.direction());
    ASSERT_TRUE(same_bits(first->closest(ray), second->closest(ray))) << i;
  }
}

FOR_EVERY_ACCELERATOR(LargeMeshes);

TEST(OwnAccelerators, PickTheFirstOfCoincidingTriangles) {
  TriangleSoup soup;
  for (int i = 0; i < 2; ++i)
    soup.add({{-1, -1, 0}, {1, -1, .5f}, {0, 1, 0}}, std::vector<Triangle>(20'000, Triangle{0, 1, 2}));
  for (const auto build : {build_bvh, build_octree}) {
    const auto hit = build(soup.geometry())->closest(make_ray({0, 0, 3}, {0, 0, -1}));
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->instance, 0u);
    EXPECT_EQ(hit->primitive, 0u);
  }
}

}  // namespace
}  // namespace vernier
