// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/scene/import_support.h"
#include "vernier/scene_file.h"

// Points and lines, which become bodies in the scene.

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

enum Mode { points, lines, loop, strip };

/// Corners of the unit square, and a white default material.
GltfFile square(Mode mode, json primitive = json::object(), json attributes = json::object()) {
  GltfFile file;
  attributes["POSITION"] = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  primitive["mode"] = mode;
  file.add_mesh(attributes, primitive);
  return file;
}

double volume(const MeshDescription& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += dot(Vec3d(mesh.positions[a]), cross(Vec3d(mesh.positions[b]), Vec3d(mesh.positions[c]))) / 6;
  return sum;
}

double area(const MeshDescription& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += length(cross(Vec3d(mesh.positions[b] - mesh.positions[a]),
                        Vec3d(mesh.positions[c] - mesh.positions[a]))) /
           2;
  return sum;
}

Vec3f center(const MeshDescription& mesh, size_t first, size_t count) {
  Vec3f sum(0, 0, 0);
  for (size_t i = 0; i < count; ++i) sum += mesh.positions[first + i] / float(count);
  return sum;
}

// The square's corners have variances of 1/4 along x and y: a box that they would fill has sqrt(6) of
// diagonal.
const double size_of_square = std::sqrt(6.0), point_radius = size_of_square / 250,
             line_radius = size_of_square / 1000;

TEST(ImportThin, PointsShowAsMuchAsSpheres) {
  const SceneDescription scene = square(points).import();
  const MeshDescription& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.triangles.size(), 4u * 8);
  ASSERT_EQ(mesh.positions.size(), 4u * 6);
  EXPECT_NEAR(area(mesh) / 4, 4 * std::numbers::pi * point_radius * point_radius, 1e-6);
  EXPECT_GT(volume(mesh), 0) << "fronts are outside";
  EXPECT_NEAR(length(center(mesh, 6, 6) - Vec3f(1, 0, 0)), 0, 1e-6);
  EXPECT_NEAR(length(center(mesh, 18, 6) - Vec3f(0, 1, 0)), 0, 1e-6);
}

TEST(ImportThin, LinesShowAsMuchAsRods) {
  const std::pair<Mode, size_t> segments[] = {{lines, 2}, {strip, 3}, {loop, 4}};
  for (const auto& [mode, count] : segments) {
    const SceneDescription scene = square(mode).import();
    const MeshDescription& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.triangles.size(), count * 16);
    EXPECT_GT(volume(mesh), 0) << "fronts are outside";
    const double walls = double(count) * 2 * std::numbers::pi * line_radius;
    EXPECT_GT(area(mesh), walls);
    EXPECT_LT(area(mesh), walls * (1 + 2 * line_radius)) << "the ends add little";
  }
  const SceneDescription closed = square(loop).import();
  EXPECT_NEAR(length(center(closed.meshes.at(0), 30, 10) - Vec3f(0, 0.5f, 0)), 0, 1e-6) << "the last side";
}

TEST(ImportThin, WithoutNormalsIsNotLit) {
  GltfFile file = square(points, {{"material", 0}});
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 0, 1}}}},
                         {"emissiveFactor", {0.5, 0, 1}}});
  const SceneDescription scene = file.import();
  EXPECT_TRUE(scene.materials.at(0).unlit);
  EXPECT_EQ(scene.materials[0].base_color, Vec4f(0.75f, 0.5f, 1, 1)) << "the sum of both";
  EXPECT_TRUE(scene.materials[0].double_sided);
  EXPECT_TRUE(scene.meshes.at(0).normals.empty());
}

TEST(ImportThin, OfAMaterialThatTrianglesHaveTooLeavesTheirsAlone) {
  GltfFile file = square(points, {{"material", 0}});
  file.add_triangle({{"material", 0}});
  file.add("materials", {{"name", "both"}});
  const SceneDescription scene = file.import();
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_TRUE(scene.materials.at(scene.instances.at(0).material).unlit);
  EXPECT_FALSE(scene.materials.at(scene.instances.at(1).material).unlit);
}

TEST(ImportThin, PointsWithNormalsAreDiscs) {
  GltfFile file = square(points);
  file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      file.add_accessor(std::vector<float>{0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, -1}, "VEC3");
  const SceneDescription scene = file.import();
  const MeshDescription& mesh = scene.meshes.at(0);
  EXPECT_FALSE(scene.materials.at(0).unlit);
  EXPECT_NEAR(area(mesh) / 4, std::numbers::pi * point_radius * point_radius, 1e-6);
  const Vec3f normals[] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3f n =
        normalize(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
    EXPECT_NEAR(dot(n, normals[a / 6]), 1, 1e-4);
    EXPECT_EQ(mesh.normals[a], normals[a / 6]);
  }
}

TEST(ImportThin, LinesWithNormalsAreLitAsTheRodsThatTheyAre) {
  GltfFile file = square(strip);
  file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const SceneDescription scene = file.import();
  const MeshDescription& mesh = scene.meshes.at(0);
  EXPECT_FALSE(scene.materials.at(0).unlit);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(mesh.normals[i].x, 0, 1e-6) << "at right angles to the first line";
}

TEST(ImportThin, KeepsColorsAndTextureCoordinatesOfVertices) {
  GltfFile file = square(lines);
  file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, "VEC3");
  const SceneDescription scene = file.import();
  const MeshDescription& mesh = scene.meshes.at(0);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const bool right = mesh.positions[i].x > 0.5f, up = mesh.positions[i].y > 0.5f;
    const Vec4f expected = up      ? right ? Vec4f(0, 0, 1, 1) : Vec4f(1, 1, 1, 1)
                                : right ? Vec4f(0, 1, 0, 1)
                                   : Vec4f(1, 0, 0, 1);
    EXPECT_EQ(mesh.colors.at(i), expected);
  }
}

TEST(ImportThin, IsAsThickInTheWorldWhateverTheScaleOfItsNode) {
  GltfFile file = square(lines);
  file.json["nodes"][0]["scale"] = {10, 10, 10};
  const SceneDescription scene = file.import();
  EXPECT_NEAR(area(scene.meshes.at(0)) * 100 / (2 * 2 * std::numbers::pi * 10 * line_radius * 10), 1, 0.01);
}

TEST(ImportThin, FollowsMorphTargetsAndJoints) {
  GltfFile file = square(points);
  const int lift = file.add_accessor(std::vector<float>{0, 0, 5, 0, 0, 5, 0, 0, 5, 0, 0, 5}, "VEC3");
  json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["targets"] = {{{"POSITION", lift}}};
  file.json["meshes"][0]["weights"] = {1};
  EXPECT_NEAR(center(file.import().meshes.at(0), 0, 24).z, 5, 1e-5);
  primitive["attributes"]["JOINTS_0"] = file.add_accessor(std::vector<uint8_t>(16, 0), "VEC4");
  primitive["attributes"]["WEIGHTS_0"] =
      file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  file.json["nodes"][0]["skin"] =
      file.add("skins", {{"joints", {file.add_root({{"translation", {0, 0, 2}}})}}});
  EXPECT_NEAR(center(file.import().meshes.at(0), 0, 24).z, 7, 1e-5);
}

TEST(ImportThin, InGreatNumberGetsTheLeastBody) {
  constexpr size_t count = 100'002;
  std::vector<float> places;
  for (size_t i = 0; i < count; ++i)
    places.insert(places.end(), {float(i % 100), float(i / 100 % 100), std::floor(float(i) / 10000)});
  for (const Mode mode : {points, strip}) {
    GltfFile file;
    file.add_mesh({{"POSITION", file.add_accessor(places, "VEC3")}}, {{"mode", mode}});
    const SceneDescription scene = file.import();
    const MeshDescription& mesh = scene.meshes.at(0);
    EXPECT_EQ(mesh.triangles.size(), mode == points ? count * 4 : (count - 1) * 6);
    EXPECT_GT(volume(mesh), 0);
  }
}

TEST(ImportThin, OneAloneHasABodyToo) {
  GltfFile file;
  file.add_mesh({{"POSITION", file.add_accessor(std::vector<float>{3, 4, 5}, "VEC3")}}, {{"mode", 0}});
  EXPECT_GT(area(file.import().meshes.at(0)), 0);
  // A line without length: its ends are all there is.
  GltfFile dot;
  dot.add_mesh({{"POSITION", dot.add_accessor(std::vector<float>{3, 4, 5, 3, 4, 5}, "VEC3")}}, {{"mode", 1}});
  EXPECT_GT(area(dot.import().meshes.at(0)), 0);
}

TEST(ImportThin, IsSaidToBeApproximated) {
  const SceneDescription scene = square(loop).import();
  ASSERT_EQ(scene.notices.size(), 1u);
  EXPECT_EQ(scene.notices[0].severity, Notice::Severity::info);
  EXPECT_THAT(scene.notices[0].text, HasSubstr("mesh.primitive.mode POINTS and LINES is approximated"));
  ImportOptions strict;
  strict.strict = true;
  EXPECT_THAT(import_error(square(loop), strict), HasSubstr("strict: mesh.primitive.mode POINTS"));
}

TEST(ImportThin, ChecksItsIndices) {
  GltfFile file = square(lines);
  file.json["meshes"][0]["primitives"][0]["indices"] =
      file.add_accessor(std::vector<uint8_t>{0, 1, 2, 4}, "SCALAR");
  EXPECT_THAT(import_error(file), HasSubstr("index 4 at position 3 is out of range, there are 4 vertices"));
}

TEST(ImportThin, IsTheSameInEveryFrame) {
  const TemporaryFolder folder;
  SceneFile file(square(loop).save(folder));
  const auto first = file.describe().meshes.at(0), second = file.describe().meshes.at(0);
  EXPECT_EQ(first.positions, second.positions);
  EXPECT_EQ(first.triangles, second.triangles);
}

}  // namespace
}  // namespace vernier::test
