// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/agreement.h"
#include "scene/accel/instance.h"
#include "tests/scene/accel_support.h"

namespace vernier {
namespace {

using namespace validation;
using test::EveryAccelerator;
using test::make_ray;

class Instances : public EveryAccelerator {};

TEST_P(Instances, PlacesInstancesWhereBakedTrianglesAre) {
  constexpr uint64_t rays = 5000;
  for (const Vec3f& scale :
       {Vec3f{1, 1, 1}, Vec3f{-1, 1, 1}, Vec3f{1, -1, -1}, Vec3f{1, 10, .1f}, Vec3f{1e-4f, 1e-4f, 1e-4f}})
    EXPECT_LE(instance_error(GetParam().build, scale, {0, 0, 0}, rays, 1), 16) << scale;
  EXPECT_LE(instance_error(GetParam().build, {1e4f, 1e4f, -1e4f}, {1e6f, -1e6f, 1e6f}, rays, 2), 16);
}

TEST_P(Instances, StretchesByAThousandEachWay) {
  TriangleSoup soup;
  const uint32_t mesh = soup.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  Transform to_world;
  to_world.x = {1, 0, 0};
  to_world.y = {0, 1e3f, 0};
  to_world.z = {0, 0, 1e-3f};
  to_world.origin = {1e6f, 0, 0};
  soup.add_instance(mesh, to_world);
  const auto hit = build(soup)->closest(make_ray({1e6f + .25f, 500, 2}, {0, 0, -1}));
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit->t, 2);
  EXPECT_FLOAT_EQ(hit->u, .25f);
  EXPECT_FLOAT_EQ(hit->v, .5f);
}

TEST_P(Instances, KeepsInstancesThatLoseADimension) {
  TriangleSoup soup;
  const uint32_t mesh = soup.add_mesh({{-1, -1, -1}, {1, -1, 1}, {0, 1, 5}}, {{0, 1, 2}});
  Transform flat;
  flat.z = {0, 0, 0};
  flat.origin = {0, 0, 2};
  soup.add_instance(mesh, flat);
  Transform point;
  point.x = point.y = point.z = {0, 0, 0};
  soup.add_instance(mesh, point);
  Transform broken;
  broken.x.y = std::numeric_limits<float>::quiet_NaN();
  soup.add_instance(mesh, broken);
  const auto accelerator = build(soup);
  const auto hit = accelerator->closest(make_ray({0, 0, 5}, {0, 0, -1}));
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->instance, 0u);
  EXPECT_FLOAT_EQ(hit->t, 3);
  std::vector<RawHit> hits;
  accelerator->all_hits(make_ray({0, 0, 5}, {0, 0, -1}), hits);
  EXPECT_EQ(hits.size(), 1u);
}

TEST_P(Instances, TellsInstancesOfOneMeshApart) {
  TriangleSoup soup;
  const uint32_t mesh = soup.add_mesh({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const auto at = [](uint32_t i, float z) {
    const uint32_t column = i % 10, row = i / 10;
    return Vec3f(float(column) * 3, float(row) * 3, z);
  };
  for (uint32_t i = 0; i < 100; ++i) {
    Transform to_world;
    to_world.origin = at(i, float(i));
    soup.add_instance(mesh, to_world);
  }
  const auto accelerator = build(soup);
  for (uint32_t i = 0; i < 100; ++i) {
    const auto hit = accelerator->closest(make_ray(at(i, 200), {0, 0, -1}));
    ASSERT_TRUE(hit) << i;
    EXPECT_EQ(hit->instance, i);
    EXPECT_FLOAT_EQ(hit->t, 200 - float(i));
  }
}

FOR_EVERY_ACCELERATOR(Instances);

TEST(WorldToMesh, InvertsInDouble) {
  Rng rng(1, 0);
  for (int i = 0; i < 1000; ++i) {
    const Transform to_world = random_placement(rng, {1, -2, .5f}, rng.in_cube(100));
    const auto to_mesh = WorldToMesh::of(to_world);
    ASSERT_TRUE(to_mesh);
    const Vec3f p = rng.in_cube(1);
    EXPECT_LT(length(to_mesh->point(to_world.point(p)) - p), 1e-4f);
    EXPECT_LT(to_mesh->distortion(to_world), 13);
    EXPECT_GE(to_mesh->distortion(to_world), 1);
  }
}

TEST(WorldToMesh, RefusesWhatLosesADimension) {
  Transform flat;
  flat.z = {0, 0, 0};
  EXPECT_FALSE(WorldToMesh::of(flat));
  Transform parallel;
  parallel.y = parallel.x + Vec3f{0, 1e-6f, 0};
  EXPECT_FALSE(WorldToMesh::of(parallel));
  Transform infinite;
  infinite.origin.x = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(WorldToMesh::of(infinite));
}

}  // namespace
}  // namespace vernier
