// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "scene/import/tangents.h"

namespace vernier::test {
namespace {

Vec3f xyz(const Vec4f& v) { return {v.x, v.y, v.z}; }

/// A quad in the plane z = 0 over the unit square, v of the texture pointing down (-y) as glTF has it.
MeshDescription quad() {
  MeshDescription mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, Vec3f(0, 0, 1));
  mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TextureUse plain() {
  TextureUse use;
  use.texture = 0;
  return use;
}

TEST(ImportTangents, FollowUAndPointBitangentsUpThePicture) {
  MeshDescription mesh = quad();
  derive_tangents(mesh, plain());
  ASSERT_EQ(mesh.tangents.size(), 4u);
  for (const Vec4f& t : mesh.tangents) {
    EXPECT_NEAR(length(xyz(t) - Vec3f(1, 0, 0)), 0, 1e-6);
    // cross(n, t) w is +y: towards smaller v.
    EXPECT_EQ(t.w, 1);
  }
}

TEST(ImportTangents, MirrorWithTheTexture) {
  MeshDescription mesh = quad();
  for (auto& uv : mesh.texcoords[0]) uv.x = 1 - uv.x;
  derive_tangents(mesh, plain());
  for (const Vec4f& t : mesh.tangents) {
    EXPECT_NEAR(length(xyz(t) - Vec3f(-1, 0, 0)), 0, 1e-6);
    EXPECT_EQ(t.w, -1);
  }
}

TEST(ImportTangents, FollowTheTexturesTransform) {
  MeshDescription mesh = quad();
  TextureUse use = plain();
  use.rotation = pi / 2;  // u' = v, v' = -u
  derive_tangents(mesh, use);
  for (const Vec4f& t : mesh.tangents) EXPECT_NEAR(length(xyz(t) - Vec3f(0, -1, 0)), 0, 1e-6);
}

TEST(ImportTangents, SplitVerticesOnAMirrorSeam) {
  // Two quads that share the edge x = 1, on which the texture is mirrored: u runs 0, 1, 0.
  MeshDescription mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  mesh.normals.assign(6, Vec3f(0, 0, 1));
  mesh.texcoords[0] = {{0, 1}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {0, 0}};
  mesh.colors.assign(6, Vec4f(1, 0, 0, 1));
  mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  derive_tangents(mesh, plain());
  EXPECT_EQ(mesh.positions.size(), 8u) << "the two vertices on the seam are there twice";
  EXPECT_EQ(mesh.tangents.size(), 8u);
  EXPECT_EQ(mesh.colors.size(), 8u);
  for (size_t t = 0; t < 4; ++t)
    for (const uint32_t vertex : mesh.triangles[t]) {
      EXPECT_NEAR(mesh.tangents[vertex].x, t < 2 ? 1 : -1, 1e-6);
      EXPECT_EQ(mesh.tangents[vertex].w, t < 2 ? 1 : -1);
    }
  EXPECT_EQ(mesh.positions[mesh.triangles[2][0]], Vec3f(1, 0, 0));
}

TEST(ImportTangents, WeightByTheAngleAtTheVertex) {
  // Three triangles around a vertex in one plane; texture directions differ. Equal position, normal and
  // texture coordinates make one vertex of the copies of the centre.
  MeshDescription mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  mesh.normals.assign(6, Vec3f(0, 0, 1));
  mesh.texcoords[0] = {{0, 0}, {1, 0}, {0, 1}, {0, 0}, {0, 1}, {-2, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  derive_tangents(mesh, plain());
  // First: u grows along x, angle 90 degrees. Second: P(u, v) has dP/du = (1/2, 0, 0) too, so both agree;
  // shear it.
  EXPECT_NEAR(length(xyz(mesh.tangents[0]) - Vec3f(1, 0, 0)), 0, 1e-6);
  mesh.tangents.clear();
  mesh.texcoords[0][5] = {-1, 0};  // u = x, v = x + y in the second triangle: dP/du = (1, -1, 0)
  derive_tangents(mesh, plain());
  const Vec3f expected = normalize(Vec3f(1, 0, 0) * (pi / 2) + normalize(Vec3f(1, -1, 0)) * (pi / 4));
  EXPECT_NEAR(length(xyz(mesh.tangents[0]) - expected), 0, 1e-6);
  EXPECT_EQ(mesh.tangents[0], mesh.tangents[3]);
}

TEST(ImportTangents, SurviveDegenerateInput) {
  MeshDescription mesh = quad();
  mesh.texcoords[0].assign(4, Vec2f(0.5f, 0.5f));
  mesh.triangles.push_back({1, 1, 2});
  derive_tangents(mesh, plain());
  for (const Vec4f& t : mesh.tangents) {
    EXPECT_NEAR(length(xyz(t)), 1, 1e-6);
    EXPECT_NEAR(t.z, 0, 1e-6);
    EXPECT_EQ(std::abs(t.w), 1);
  }
}

TEST(ImportTangents, GiveAMeshWithoutNormalsThoseOfItsTriangles) {
  MeshDescription mesh = quad();
  mesh.normals.clear();
  mesh.positions[3] = {0, 1, 1};
  derive_tangents(mesh, plain());
  ASSERT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.normals[mesh.triangles[0][0]], Vec3f(0, 0, 1));
  for (const auto& triangle : mesh.triangles) {
    const Vec3f face = normalize(cross(mesh.positions[triangle[1]] - mesh.positions[triangle[0]],
                                       mesh.positions[triangle[2]] - mesh.positions[triangle[0]]));
    for (const uint32_t vertex : triangle) {
      EXPECT_NEAR(length(mesh.normals[vertex] - face), 0, 1e-6);
      EXPECT_NEAR(dot(xyz(mesh.tangents[vertex]), face), 0, 1e-6);
    }
  }
}

}  // namespace
}  // namespace vernier::test
