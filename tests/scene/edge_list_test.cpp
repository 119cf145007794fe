// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/edge_list.h"

#include "scene/accel/brute_force.h"
#include "scene/scene.h"
#include "tests/scene/accel_support.h"
#include "tests/support/effort.h"
#include "tests/support/test_scenes.h"

namespace vernier {
namespace {

using namespace validation;
using test::make_ray;
using test::same_bits;

/// A triangle with sides of 1 and sqrt(2), `size` times as large.
void add_corner(TriangleSoup& soup, const Vec3f& at, float size) {
  soup.add({at, at + Vec3f(size, 0, 0), at + Vec3f(0, size, 0)}, {{0, 1, 2}});
}

void add_corners(TriangleSoup& soup, int count) {
  for (int i = 0; i < count; ++i) add_corner(soup, {float(i), 0, float(i % 3)}, 1);
}

TEST(EdgeList, SuitsAFewDozenTrianglesAtRest) {
  TriangleSoup none, few, many;
  add_corners(few, 64);
  add_corners(many, 65);
  EXPECT_TRUE(suits_edge_list(none.geometry()));
  EXPECT_TRUE(suits_edge_list(few.geometry()));
  EXPECT_FALSE(suits_edge_list(many.geometry()));
  EXPECT_EQ(quickest_accelerator(few.geometry()).name, "list");
  EXPECT_EQ(quickest_accelerator(many.geometry()).name, "embree");

  TriangleSoup placed, moving;
  add_corners(placed, 3);
  placed.add_instance(0, {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {}});
  EXPECT_FALSE(suits_edge_list(placed.geometry()));
  const std::vector<Vec3f> here{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  moving.add_moving({here, here}, {{0, 1, 2}});
  EXPECT_FALSE(suits_edge_list(moving.geometry()));
}

/// Rays of all kinds, from any distance, through anything: they tell whether the test of eight triangles lets
/// one go that is met.
TEST(EdgeList, AnswersAsBruteForceDoesToTheBit) {
  uint64_t met = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed, 3);
    TriangleSoup soup;
    const uint32_t count = 1 + rng.below(130);
    const Vec3f center = rng.in_cube(seed % 4 ? 0 : rng.magnitude(1, 1e5f));
    const Vec3f stretch{rng.magnitude(1e-4f, 1), rng.magnitude(1e-2f, 1), 1};
    const float unit = rng.magnitude(1e-12f, 1e12f);
    const auto anywhere = [&](float half) { return (rng.in_cube(half) * stretch + center) * unit; };
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    for (uint32_t i = 0; i < count; ++i) {
      const float size = rng.magnitude(1e-4f, 1);
      const Vec3f at = anywhere(1);
      for (int k = 0; k < 3; ++k) positions.push_back(at + rng.in_cube(size) * stretch * unit);
      triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    soup.add(positions, triangles);
    const auto list = build_edge_list(soup.geometry()), truth = build_brute_force(soup.geometry());
    for (int i = 0; i < 4000 / test::thinning; ++i) {
      // At a corner, along an edge or anywhere in a triangle; past its ends or not.
      const Vec3f* corners = &positions[3 * rng.below(count)];
      const float a = i % 4 == 0 ? 0 : rng.uniform(0, .5f), b = i % 4 < 2 ? 0 : rng.uniform(0, .5f);
      const Vec3f goal = corners[0] * (1 - a - b) + corners[1] * a + corners[2] * b;
      const Vec3f from = i % 8 == 3 ? goal + (corners[1] - corners[0]) * rng.magnitude(1e-2f, 1e2f)
                                    : anywhere(rng.magnitude(.1f, 100));
      Ray ray = make_ray(from, (goal - from) * rng.magnitude(1e-3f, 1e3f) / unit);
      if (i % 3 == 0)
        if (const auto far = truth->closest(ray))
          (i % 2 ? ray.t_min : ray.t_max) = far->t * rng.uniform(1 - 4e-7f, 1 + 4e-7f);
      const auto expected = truth->closest(ray);
      met += expected.has_value();
      ASSERT_TRUE(same_bits(list->closest(ray), expected)) << seed << ' ' << i;
      ASSERT_EQ(list->occluded(ray), expected.has_value()) << seed << ' ' << i;
    }
  }
  EXPECT_GT(met, 400'000u / test::thinning);
}

TEST(EdgeList, IsTakenForSmallScenes) {
  test::SceneBuilder small, large;
  small.add(test::box({-1, 0, -1}, {1, 2, 1}, true), test::diffuse(.5f));
  large.add(test::sphere({0, 1, 0}, 1, 8, 16), test::diffuse(.5f));
  EXPECT_EQ(small.build().accelerator_name(), "list");
  EXPECT_EQ(small.build("embree").accelerator_name(), "embree");
  EXPECT_EQ(large.build().accelerator_name(), "embree");
}

}  // namespace
}  // namespace vernier
