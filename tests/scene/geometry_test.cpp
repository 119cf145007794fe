// SPDX-License-Identifier: Apache-2.0
#include "scene/geometry.h"

#include <gtest/gtest.h>

#include "core/math/frame.h"
#include "core/sampling/warp.h"
#include "tests/support/random.h"
#include "tests/support/test_scenes.h"

// What is told of a point of an instance does not depend on whether its mesh has other instances: a mesh that
// is used once is moved into world space, where the same is calculated in another way.

namespace vernier::test {
namespace {

/// Turned and enlarged, and with as many axes turned about as the number says: mirrored by 1 and 3 of them.
/// Not stretched, since normals are interpolated before they are placed or after it.
Transform any_placement(int turned_about, Random& random) {
  const Frame frame = Frame::from_normal(sample_sphere(random.next2()));
  const float size = 0.5f + 2 * random.next1();
  const auto scale = [&](int axis) { return axis < turned_about ? -size : size; };
  return {frame.x * scale(0), frame.y * scale(1), frame.z * scale(2), {3, -2, 1}};
}

/// A sphere with normals of its own, its texture askew, with tangents and without.
MeshDescription textured_sphere(bool has_tangents) {
  MeshDescription mesh = smooth_sphere({0, 0, 0}, 1, 6, 9);
  mesh.texcoords[0].clear();
  for (const Vec3f& p : mesh.positions) {
    mesh.texcoords[0].emplace_back(p.x + 2 * p.z, p.y - p.x);
    if (!has_tangents) continue;
    const Vec3f tangent = Frame::from_normal(p).x;
    mesh.tangents.emplace_back(tangent.x, tangent.y, tangent.z, -1.f);
  }
  return mesh;
}

void expect_near(const Vec3f& found, const Vec3f& expected, const char* what) {
  EXPECT_LT(length(found - expected), 2e-5f) << what << " " << found << " " << expected;
}

/// What is told of a whole triangle at once is what is told of its corners.
void expect_same_triangle(const SceneGeometry& geometry, uint32_t primitive) {
  const PlacedTriangle placed = geometry.placed_triangle(0, primitive, middle_of_shutter);
  for (size_t k = 0; k < 3; ++k) {
    const SurfacePoint corner = geometry.surface_point(0, primitive, {float(k == 1), float(k == 2)});
    expect_near(placed.corners[k], corner.position, "corner");
    const auto& [a, b, c] = placed.corners;
    EXPECT_EQ(dot(cross(b - a, c - a), corner.ng) < 0, placed.is_mirrored);
  }
  for (const Vec2f& corner : {Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)}) {
    const Vec3f error = geometry.surface_point(0, primitive, corner).error;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(placed.error[axis], error[axis] * (1 - 1e-6f));
      EXPECT_LE(placed.error[axis], 4 * max_component(error));
    }
  }
}

/// Of one triangle's points: instance 0 of `shared` against the only one of `baked`, whose winding is turned
/// where it is mirrored.
void expect_same_point(const SceneGeometry& shared, const SceneGeometry& baked, uint32_t primitive,
                       bool is_mirrored) {
  const Vec2f at(0.2f, 0.5f);
  const SurfacePoint a = shared.surface_point(0, primitive, at);
  const SurfacePoint b = baked.surface_point(0, primitive, is_mirrored ? Vec2f(at.y, at.x) : at);
  expect_near(a.position, b.position, "position");
  expect_near(a.ng, b.ng, "geometric normal");
  const Vec3f normal = baked.shading_normal(b);
  expect_near(shared.shading_normal(a), normal, "shading normal");
  EXPECT_GT(dot(a.ng, normal), 0.5f) << "the normals are on the same side";
  const auto x = shared.tangent_frame(a, normal, 0), y = baked.tangent_frame(b, normal, 0);
  expect_near(x.tangent, y.tangent, "tangent");
  expect_near(x.bitangent, y.bitangent, "bitangent");
  for (size_t k = 0; k < 3; ++k)
    expect_near(shared.triangle(0, primitive)[k], baked.triangle(0, primitive)[k], "corner");
}

TEST(Geometry, APointOfAnInstanceIsWhatItIsInWorldSpace) {
  Random random(5);
  for (int trial = 0; trial < 8; ++trial) {
    const Transform to_world = any_placement(trial % 4, random);
    const MeshDescription mesh = textured_sphere(trial < 4);
    InstanceDescription placed, other;
    placed.to_world = to_world;
    const SceneGeometry shared({mesh}, {placed, other}), baked({mesh}, {placed});
    for (uint32_t primitive = 0; primitive < shared.triangle_count(0); ++primitive) {
      expect_same_point(shared, baked, primitive, to_world.determinant() < 0);
      expect_same_triangle(shared, primitive);
      expect_same_triangle(baked, primitive);
    }
  }
}

TEST(Geometry, AMirroredInstanceIsSeenFromItsFront) {
  SceneDescription description =
      SceneBuilder().add(smooth_sphere({0, 0, 0}, 1, 12, 24), diffuse(0.5f)).description();
  InstanceDescription other = description.instances.front();
  other.to_world = {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 0, 0}};
  description.instances.push_back(other);
  const Scene scene(std::move(description), {});
  for (const float x : {0.f, 5.f}) {
    Ray ray;
    ray.origin = {x, 0, 4};
    ray.direction = {0, 0, -1};
    const auto hit = scene.intersect(ray);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->position.z, 1, 0.02) << "the front of " << x;
    EXPECT_TRUE(hit->front) << x;
  }
}

}  // namespace
}  // namespace vernier::test
