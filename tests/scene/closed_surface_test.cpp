#include "scene/closed_surface.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "tests/scene/import_support.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A sphere of n x 2n quads, or triangles at the poles, each triangle with vertices of its own.
MeshDescription sphere(int n) {
  MeshDescription mesh;
  const auto point = [&](int row, int column) {
    const double theta = std::numbers::pi * row / n, phi = std::numbers::pi * (column % (2 * n)) / n;
    const double r = row == 0 || row == n ? 0 : std::sin(theta);
    return Vec3f(float(r * std::cos(phi)), float(std::cos(theta)), float(r * std::sin(phi)));
  };
  const auto add = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const uint32_t first = uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < 2 * n; ++column) {
      add(point(row, column), point(row, column + 1), point(row + 1, column));
      add(point(row + 1, column), point(row, column + 1), point(row + 1, column + 1));
    }
  return mesh;
}

bool is_closed(const MeshDescription& mesh) {
  const MeshDescription* const meshes[] = {&mesh};
  return is_closed_surface(meshes);
}

TEST(ClosedSurface, SpheresAreClosedWhateverTheirVertices) {
  for (const int n : {2, 3, 20, 200}) EXPECT_TRUE(is_closed(sphere(n))) << n;
}

TEST(ClosedSurface, OneTriangleLessOpensIt) {
  const MeshDescription whole = sphere(20);
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    MeshDescription mesh = whole;
    // Those at the poles are lines and do not count.
    const size_t triangle = 80 + random() % (mesh.triangles.size() - 160);
    mesh.triangles.erase(mesh.triangles.begin() + ptrdiff_t(triangle));
    EXPECT_FALSE(is_closed(mesh)) << triangle;
  }
}

TEST(ClosedSurface, OneVertexMovedByOneBitOpensIt) {
  MeshDescription mesh = sphere(20);
  mesh.positions[300].x = std::nextafter(mesh.positions[300].x, 2.f);
  EXPECT_FALSE(is_closed(mesh));
}

TEST(ClosedSurface, ZeroHasNoSign) {
  MeshDescription mesh = sphere(20);
  for (size_t i = 0; i < mesh.positions.size(); i += 2)
    for (int axis = 0; axis < 3; ++axis)
      if (mesh.positions[i][axis] == 0) mesh.positions[i][axis] = -0.f;
  EXPECT_TRUE(is_closed(mesh));
}

TEST(ClosedSurface, PartsCloseEachOther) {
  const MeshDescription whole = sphere(20);
  MeshDescription upper = whole, lower = whole;
  upper.triangles.resize(whole.triangles.size() / 3);
  lower.triangles.erase(lower.triangles.begin(), lower.triangles.begin() + ptrdiff_t(upper.triangles.size()));
  EXPECT_FALSE(is_closed(upper));
  EXPECT_FALSE(is_closed(lower));
  const MeshDescription* const parts[] = {&upper, &lower};
  EXPECT_TRUE(is_closed_surface(parts));
}

TEST(ClosedSurface, SheetsAreOpenAndTheirTwoSidesClosed) {
  MeshDescription sheet;
  sheet.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {1, 3, 2}};
  EXPECT_FALSE(is_closed(sheet));
  sheet.triangles.push_back({2, 1, 0});
  sheet.triangles.push_back({2, 3, 1});
  EXPECT_TRUE(is_closed(sheet)) << "encloses nothing, but has no edge";
}

/// A tetrahedron whose faces are given to primitives of these materials.
GltfFile tetrahedron(const std::vector<int>& materials_of_faces) {
  GltfFile file;
  const int positions = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  const std::vector<std::vector<uint16_t>> faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  json primitives = json::array();
  for (size_t face = 0; face < materials_of_faces.size(); ++face)
    primitives.push_back({{"attributes", {{"POSITION", positions}}},
                          {"indices", file.add_accessor(faces[face], "SCALAR")},
                          {"material", materials_of_faces[face]}});
  const json volume = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                       {"KHR_materials_volume", {{"thicknessFactor", 1}}}};
  file.add("materials", {{"extensions", volume}});
  file.add("materials", {{"extensions", volume}, {"name", "the same but for its name"}});
  file.add("materials", {{"name", "no volume"}});
  file.add("materials", {{"extensions", {{"KHR_materials_volume", {{"thicknessFactor", 1}}}}}});
  file.add("meshes", {{"name", "vase"}, {"primitives", primitives}});
  file.add_root({{"mesh", 0}});
  file.add_root({{"mesh", 0}, {"translation", {5, 0, 0}}});
  return file;
}

TEST(OpenVolumes, AreNamed) {
  const SceneDescription scene = tetrahedron({0, 0, 0}).import();
  ASSERT_EQ(scene.notices.size(), 1u) << "once, however many nodes show it";
  EXPECT_EQ(scene.notices[0].place, "/meshes/0");
  EXPECT_THAT(scene.notices[0].text, HasSubstr("the mesh 'vase' is not closed; its volume"));
  EXPECT_EQ(scene.notices[0].severity, Notice::Severity::warning);
}

TEST(OpenVolumes, MayBeClosedBySeveralPrimitives) {
  EXPECT_TRUE(tetrahedron({0, 0, 0, 0}).import().notices.empty());
  EXPECT_TRUE(tetrahedron({0, 1, 0, 1}).import().notices.empty());
  EXPECT_TRUE(has_notice(tetrahedron({0, 1, 0, 2}).import(), "not closed")) << "a wall is no boundary";
}

TEST(OpenVolumes, AreThoseOfMaterialsThatLetLightIn) {
  EXPECT_TRUE(tetrahedron({2, 2}).import().notices.empty());
  EXPECT_TRUE(tetrahedron({3, 3}).import().notices.empty());
}

TEST(OpenVolumes, MayBeTornOpenByMorphing) {
  GltfFile file = tetrahedron({0, 0, 0, 0});
  const int moved = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", moved}}};
  file.json["meshes"][0]["weights"] = {0};
  EXPECT_TRUE(file.import().notices.empty());
  file.json["meshes"][0]["weights"] = {1};
  EXPECT_TRUE(has_notice(file.import(), "not closed"));
}

}  // namespace
}  // namespace vernier::test
