// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/agreement.h"
#include "apps/validation/invariance.h"
#include "apps/validation/limits.h"
#include "scene/accel/bvh.h"
#include "tests/scene/accel_support.h"

namespace vernier {
namespace {

using namespace validation;
using test::EveryAccelerator;
using test::make_ray;
using test::same_bits;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Squares z = 1, 2, 3, two triangles each, and which hits a downward ray from z = 4 has.
struct Sheets {
  TriangleSoup soup;
  Sheets() {
    for (const float z : {1.f, 2.f, 3.f})
      soup.add({{-1, -1, z}, {1, -1, z}, {-1, 1, z}, {1, 1, z}}, {{0, 1, 2}, {1, 3, 2}});
  }
};
const Vec3f above{.25f, -.5f, 4}, down{0, 0, -1};

class Queries : public EveryAccelerator {};

TEST_P(Queries, FindsTheNearestHitWithItsBarycentrics) {
  Sheets sheets;
  const auto hit = build(sheets.soup)->closest(make_ray(above, down));
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit->t, 1);  // Embree's reciprocals differ from processor to processor
  EXPECT_EQ(hit->instance, 2u);
  EXPECT_EQ(hit->primitive, 0u);
  EXPECT_FLOAT_EQ(hit->u, .625f);  // weight of the second vertex
  EXPECT_FLOAT_EQ(hit->v, .25f);   // of the third
}

TEST_P(Queries, ListsAllHitsByDistanceEachTriangleOnce) {
  Sheets sheets;
  std::vector<RawHit> hits(7);
  const auto accelerator = build(sheets.soup);
  accelerator->all_hits(make_ray(above, down), hits);
  ASSERT_EQ(hits.size(), 3u);
  for (uint32_t i = 0; i < 3; ++i) {
    EXPECT_FLOAT_EQ(hits[i].t, float(1 + i));
    EXPECT_EQ(hits[i].instance, 2 - i);
  }
  accelerator->all_hits(make_ray(above, down, 1.5f, 2.5f), hits);
  ASSERT_EQ(hits.size(), 1u);
  EXPECT_EQ(hits[0].instance, 1u);
}

TEST_P(Queries, PassesTheTrianglesAtTheEndsOfTheRay) {
  Sheets sheets;
  const auto accelerator = build(sheets.soup);
  Ray ray = make_ray(above, down, 0, 2.5f);  // sheets 2 and 1
  ray.origin_triangle = {2, 0};
  const auto hit = accelerator->closest(ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->instance, 1u);
  EXPECT_TRUE(accelerator->occluded(ray));
  std::vector<RawHit> hits;
  accelerator->all_hits(ray, hits);
  EXPECT_EQ(hits.size(), 1u);
  ray.target_triangle = {1, 0};
  EXPECT_FALSE(accelerator->closest(ray));
  EXPECT_FALSE(accelerator->occluded(ray));
  accelerator->all_hits(ray, hits);
  EXPECT_TRUE(hits.empty());
  ray.target_triangle = {1, 1};  // the other half of the sheet is not the one met
  EXPECT_TRUE(accelerator->occluded(ray));
}

TEST_P(Queries, TakesTheIntervalAsOpen) {
  Sheets sheets;
  const auto accelerator = build(sheets.soup);
  const auto t = [&](float t_min, float t_max) {
    const Ray ray = make_ray(above, down, t_min, t_max);
    const auto hit = accelerator->closest(ray);
    EXPECT_EQ(hit.has_value(), accelerator->occluded(ray));
    return hit ? hit->t : 0;
  };
  std::vector<RawHit> hits;
  accelerator->all_hits(make_ray(above, down), hits);
  ASSERT_EQ(hits.size(), 3u);
  const float t1 = hits[0].t, t2 = hits[1].t, t3 = hits[2].t;
  if (GetParam().name != "embree-fast") {  // which compares t times the determinant, which rounds
    EXPECT_EQ(t(0, t1), 0);
    EXPECT_EQ(t(t1, infinity), t2);
    EXPECT_EQ(t(t1, t2), 0);
    EXPECT_EQ(t(t3, infinity), 0);
  }
  EXPECT_EQ(t(0, 1.0001f), t1);
  EXPECT_EQ(t(.9999f, infinity), t1);
  EXPECT_EQ(t(1.0001f, 1.9999f), 0);
  EXPECT_EQ(t(2, 1), 0);
  EXPECT_EQ(t(0, 0), 0);
  EXPECT_EQ(t(-5, infinity), t1);
  EXPECT_EQ(t(-5, -1), 0);
  EXPECT_EQ(t(infinity, infinity), 0);
  EXPECT_EQ(t(nan, infinity), 0);
  EXPECT_EQ(t(0, nan), 0);
}

TEST_P(Queries, TakesTheIntervalAsOpenToTheLastBit) {
  const Count errors = interval_errors(GetParam().build, 20'000, 1);
  // Embree's fast mode compares t times the determinant, which rounds.
  if (GetParam().name == "embree-fast")
    EXPECT_LT(errors.per_million(), 500'000);
  else
    EXPECT_EQ(errors.events, 0u);
}

TEST_P(Queries, DoesNotMeetTheSurfaceItStartsOn) {
  Sheets sheets;
  const auto hit = build(sheets.soup)->closest(make_ray({.25f, -.5f, 3}, down));
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->instance, 1u);
}

TEST_P(Queries, MissesWithInvalidRays) {
  Sheets sheets;
  const auto accelerator = build(sheets.soup);
  std::vector<RawHit> hits;
  for (const float bad : {nan, infinity, -infinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      Ray ray = make_ray(above, down);
      ray.origin[axis] = bad;
      EXPECT_FALSE(accelerator->closest(ray));
      EXPECT_FALSE(accelerator->occluded(ray));
      ray = make_ray(above, down);
      ray.direction[axis] = bad;
      EXPECT_FALSE(accelerator->closest(ray));
      accelerator->all_hits(ray, hits);
      EXPECT_TRUE(hits.empty());
    }
  }
  EXPECT_FALSE(accelerator->closest(make_ray(above, {0, 0, 0})));
  EXPECT_FALSE(accelerator->closest(make_ray(above, {0, -0.f, 0})));
}

TEST_P(Queries, CountsBothSides) {
  Sheets sheets;
  const auto hit = build(sheets.soup)->closest(make_ray({.25f, -.5f, 0}, {0, 0, 1}));
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->instance, 0u);
}

TEST_P(Queries, MissesInAnEmptySceneAndWithEmptyMeshes) {
  TriangleSoup nothing, empty_mesh;
  empty_mesh.add({}, {});
  empty_mesh.add({{0, 0, 0}}, {});
  for (const TriangleSoup* soup : {&nothing, &empty_mesh}) {
    const auto accelerator = build(*soup);
    std::vector<RawHit> hits(3);
    EXPECT_FALSE(accelerator->closest(make_ray(above, down)));
    EXPECT_FALSE(accelerator->occluded(make_ray(above, down)));
    accelerator->all_hits(make_ray(above, down), hits);
    EXPECT_TRUE(hits.empty());
  }
}

TEST_P(Queries, MissesTrianglesWithoutAreaAndRaysInTheirPlane) {
  TriangleSoup soup;
  soup.add({{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {1, 0, 0}, {0, 1, 0}},
           {{0, 1, 2}, {0, 0, 1}, {1, 1, 1}, {0, 3, 4}});
  const auto accelerator = build(soup);
  EXPECT_FALSE(accelerator->closest(make_ray({1, 2, 9}, down)));
  EXPECT_FALSE(accelerator->closest(make_ray({.5f, 1, 9}, down)));
  EXPECT_FALSE(accelerator->closest(make_ray({-1, .5f, 0}, {1, 0, 0})));
  // pbrt's BadCases: a ray at a triangle that is a line
  TriangleSoup line;
  line.add({{-1113.45459f, -79.049614f, -56.2431908f},
            {-1113.45459f, -87.0922699f, -56.2431908f},
            {-1113.45459f, -79.2090149f, -56.2431908f}},
           {{0, 1, 2}});
  EXPECT_FALSE(build(line)->closest(make_ray({-1081.47925f, 99.9999542f, 87.7701111f},
                                             {-32.1072998f, -183.355865f, -144.607635f}, 0, .9999f)));
}

TEST_P(Queries, DropsTrianglesThatAreNotFinite) {
  TriangleSoup soup;
  soup.add({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {nan, 0, 1}, {0, infinity, 1}, {-infinity, 0, nan}},
           {{0, 1, 3}, {0, 1, 2}, {1, 2, 4}, {0, 2, 5}, {3, 4, 5}});
  const auto accelerator = build(soup);
  Rng rng(1, 0);
  for (int i = 0; i < 1000; ++i) {
    const auto hit = accelerator->closest(make_ray(rng.in_cube(5), rng.direction()));
    if (hit) {
      EXPECT_EQ(hit->primitive, 1u);
      EXPECT_TRUE(std::isfinite(hit->t));
    }
  }
  EXPECT_TRUE(accelerator->occluded(make_ray({0, 0, 2}, down)));
}

TEST_P(Queries, SurvivesDenormalAndHugeCoordinates) {
  for (const float size : {1e-40f, 1e-20f, 1e9f, 1e12f, 1e15f, 1e17f}) {
    TriangleSoup soup;
    soup.add({{0, 0, 0}, {size, 0, 0}, {0, size, 0}}, {{0, 1, 2}});
    const auto beside = build(soup)->closest(make_ray({1.1f * size, .25f * size, size}, down));
    EXPECT_FALSE(beside && std::abs(beside->t / size - 1) < 1e-3f) << size;
  }
  // Embree multiplies three lengths where the reference multiplies two.
  const bool reference = GetParam().watertight == Watertight::at_edges_and_vertices;
  for (const bool flush_denormals : {false, true}) {
    const SizeRange sizes = sizes_hit(GetParam().build, flush_denormals);
    EXPECT_LE(sizes.smallest, reference ? 1.01e-19 : 1.01e-9);
    EXPECT_GE(sizes.largest, reference ? .99e17 : .99e12);
  }
}

TEST_P(Queries, ScalesByPowersOfTwoToTheBit) {
  const Count changed = changed_by_scaling(GetParam().build, 20'000, 1);
  EXPECT_EQ(changed.events, 0u);
  EXPECT_EQ(changed.trials, 20'000u);
}

TEST_P(Queries, HitsNothingWhereNothingCanBeHit) {
  EXPECT_EQ(phantom_hits(GetParam().build, 20'000, 1).events, 0u);
}

TEST_P(Queries, ScalesWithDirectionsOfAnyLength) {
  Sheets sheets;
  const auto accelerator = build(sheets.soup);
  for (const float length : {1e-30f, 1e-20f, 1e-12f, 1e-3f, 1e3f, 1e12f, 1e20f, 1e30f}) {
    const auto hit = accelerator->closest(make_ray(above, down * length));
    ASSERT_TRUE(hit) << length;
    EXPECT_EQ(hit->instance, 2u);
    EXPECT_NEAR(hit->t * length, 1, 1e-6) << length;
    EXPECT_FALSE(accelerator->occluded(make_ray(above, down * length, 0, .99f / length))) << length;
  }
}

TEST_P(Queries, IgnoresTheSignsOfZeros) {
  const Count changed = changed_by_signed_zeros(GetParam().build);
  EXPECT_EQ(changed.events, 0u);
  EXPECT_GT(changed.trials, 20'000u);
}

TEST_P(Queries, StaysWithinTheForwardErrorBound) {
  // Embree's robust mode weighs by its edge functions' rounded sum, which costs it u and v of rays from afar.
  const double bound = GetParam().name == "embree" ? 20 : 1;
  for (const float needle : {1.f, .1f}) {
    const HitErrors errors = hit_errors(GetParam().build, needle, 0, 30'000, 5);
    EXPECT_EQ(errors.wrong.events, 0u) << needle;
    EXPECT_LE(errors.t, 1) << needle;
    EXPECT_LE(errors.u, bound) << needle;
    EXPECT_LE(errors.v, bound) << needle;
  }
}

/// Lets every other sheet through, and remembers whether it saw the ray in world space.
class EverySecondSheet : public HitFilter {
 public:
  bool accept(const Ray& ray, const RawHit& hit) const override {
    EXPECT_EQ(ray.origin, above);
    EXPECT_NEAR((ray.origin + ray.direction * hit.t).z, float(hit.instance + 1), 1e-5);
    return hit.instance % 2 == 0;
  }
};

TEST_P(Queries, AsksTheFilterWhereInstancesAreFiltered) {
  EverySecondSheet filter;
  TriangleSoup soup;
  const uint32_t mesh =
      soup.add_mesh({{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}});
  for (uint32_t i = 0; i < 4; ++i) {
    Transform to_world;
    to_world.origin.z = float(i + 1);
    soup.add_instance(mesh, to_world, i < 3);
  }
  soup.set_filter(&filter);
  const auto accelerator = build(soup);
  const auto hit = accelerator->closest(make_ray(above, down));  // starts on the unfiltered sheet 3
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->instance, 2u);
  EXPECT_FALSE(accelerator->occluded(make_ray(above, down, 1.5f, 2.5f)));
  EXPECT_TRUE(accelerator->occluded(make_ray(above, down, 2.5f, 3.5f)));
  std::vector<RawHit> hits;
  accelerator->all_hits(make_ray(above, down), hits);
  ASSERT_EQ(hits.size(), 2u);
  EXPECT_EQ(hits[0].instance, 2u);
  EXPECT_EQ(hits[1].instance, 0u);
}

FOR_EVERY_ACCELERATOR(Queries);

}  // namespace
}  // namespace vernier
