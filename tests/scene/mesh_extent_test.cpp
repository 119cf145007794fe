// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh_extent.h"

#include <gtest/gtest.h>

#include "core/math/frame.h"
#include "core/sampling/warp.h"
#include "scene/geometry.h"
#include "tests/support/random.h"

// Where meshes end, against all of their corners.

namespace vernier::test {
namespace {

/// A strip of triangles that winds about; `order`: its triangles follow each other, else are shuffled.
MeshDescription strip(size_t triangles, bool order, Random& random) {
  MeshDescription mesh;
  Vec3f place(50, -3, 7);
  for (size_t i = 0; i < triangles + 2; ++i) {
    place += 0.1f * sample_sphere(random.next2());
    mesh.positions.push_back(place);
  }
  for (uint32_t i = 0; i < triangles; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  if (order) return mesh;
  for (size_t i = triangles; i > 1; --i)
    std::swap(mesh.triangles[i - 1], mesh.triangles[std::min(i - 1, size_t(random.next1() * float(i)))]);
  return mesh;
}

/// Anything but a projection: turned, mirrored, stretched, far away.
Transform any_transform(Random& random) {
  const Frame frame = Frame::from_normal(sample_sphere(random.next2()));
  const auto scale = [&] {
    return std::pow(10.f, 4 * random.next1() - 2) * (random.next1() < 0.3f ? -1.f : 1.f);
  };
  return {frame.x * scale(), frame.y * scale(), frame.z * scale(),
          1000 * random.next1() * sample_sphere(random.next2())};
}

std::vector<Vec3f> finite_corners(const MeshDescription& mesh, const Transform& to_world) {
  std::vector<Vec3f> corners;
  for (const Triangle& triangle : mesh.triangles)
    for (const uint32_t vertex : triangle)
      if (const Vec3f p = to_world.point(mesh.positions[vertex]); is_finite(p)) corners.push_back(p);
  return corners;
}

void expect_same_as_all_corners(const MeshDescription& mesh, Random& random) {
  const MeshExtent extent(mesh.positions, mesh.triangles);
  for (int trial = 0; trial < 20; ++trial) {
    const Transform to_world = trial == 0 ? Transform{} : any_transform(random);
    const std::vector<Vec3f> corners = finite_corners(mesh, to_world);
    Bounds expected;
    for (const Vec3f& p : corners) expected.add(p);
    const Bounds found = extent.bounds(to_world);
    ASSERT_EQ(found.lower, expected.lower);
    ASSERT_EQ(found.upper, expected.upper);
    const Vec3f direction = trial % 2 ? sample_sphere(random.next2()) : Vec3f(0, 0, 1);
    FarthestCorner first;
    for (const Vec3f& p : corners)
      if (dot(p, direction) > first.along) first = {p, dot(p, direction)};
    const FarthestCorner farthest = extent.farthest(to_world, direction);
    ASSERT_EQ(farthest.along, first.along);
    ASSERT_EQ(farthest.point, first.point);
  }
}

TEST(MeshExtent, IsThatOfAllCornersToTheLastBit) {
  Random random(3);
  for (const size_t triangles : {1u, 31u, 32u, 33u, 256u, 257u, 5000u})
    for (const bool order : {true, false})
      expect_same_as_all_corners(strip(triangles, order, random), random);
}

TEST(MeshExtent, LeavesOutCornersThatAreNotFinite) {
  Random random(4);
  MeshDescription mesh = strip(3000, true, random);
  mesh.positions[17].x = std::numeric_limits<float>::quiet_NaN();
  mesh.positions[1800].y = std::numeric_limits<float>::infinity();
  for (size_t i = 2000; i < 2200; ++i) mesh.positions[i].z = -std::numeric_limits<float>::infinity();
  expect_same_as_all_corners(mesh, random);
  for (Vec3f& p : mesh.positions) p.x = std::numeric_limits<float>::quiet_NaN();
  const MeshExtent extent(mesh.positions, mesh.triangles);
  EXPECT_TRUE(extent.bounds({}).empty());
  EXPECT_EQ(extent.farthest({}, {1, 0, 0}).along, -std::numeric_limits<float>::infinity());
}

TEST(MeshExtent, OfNoTrianglesIsNothing) {
  EXPECT_TRUE(MeshExtent().bounds({}).empty());
  EXPECT_EQ(MeshExtent({}, {}).farthest({}, {1, 0, 0}).along, -std::numeric_limits<float>::infinity());
}

TEST(MeshExtent, OfEqualsTheFirstIsFarthest) {
  MeshDescription mesh;
  for (int i = 0; i < 200; ++i) mesh.positions.emplace_back(float(i % 10), float(i), 0.f);
  for (uint32_t i = 0; i + 2 < 200; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  // Vertex 9 comes first in the triangle of 7, 8 and 9.
  EXPECT_EQ(MeshExtent(mesh.positions, mesh.triangles).farthest({}, {1, 0, 0}).point, Vec3f(9, 9, 0));
}

TEST(SceneGeometry, BoundsOfInstancesAreThoseOfTheirTriangles) {
  Random random(6);
  const MeshDescription mesh = strip(1000, true, random);
  std::vector<InstanceDescription> instances(50);
  for (size_t i = 1; i < instances.size(); ++i) instances[i].to_world = any_transform(random);
  const SceneGeometry geometry({mesh}, instances);
  Bounds all;
  for (uint32_t i = 0; i < instances.size(); ++i) {
    Bounds expected;
    for (const Vec3f& p : finite_corners(mesh, instances[i].to_world)) expected.add(p);
    EXPECT_EQ(geometry.bounds(i).lower, expected.lower);
    EXPECT_EQ(geometry.bounds(i).upper, expected.upper);
    all.add(expected);
  }
  EXPECT_EQ(geometry.bounds().lower, all.lower);
  EXPECT_EQ(geometry.bounds().upper, all.upper);
}

}  // namespace
}  // namespace vernier::test
