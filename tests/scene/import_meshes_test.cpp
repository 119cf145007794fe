// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "tests/scene/import_support.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<float> five_points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};

template <typename T>
GltfFile indexed(const std::vector<T>& indices, int mode) {
  GltfFile file;
  const int positions = file.add_accessor(five_points, "VEC3");
  file.add_mesh({{"POSITION", positions}},
                {{"indices", file.add_accessor(indices, "SCALAR")}, {"mode", mode}});
  return file;
}

TEST(ImportMeshes, ReadsListsOfEveryIndexType) {
  const Triangle first{2, 1, 0}, second{3, 4, 2};
  EXPECT_THAT(indexed<uint8_t>({2, 1, 0, 3, 4, 2}, 4).import().meshes.at(0).triangles,
              ElementsAre(first, second));
  EXPECT_THAT(indexed<uint16_t>({2, 1, 0, 3, 4, 2}, 4).import().meshes.at(0).triangles,
              ElementsAre(first, second));
  EXPECT_THAT(indexed<uint32_t>({2, 1, 0, 3, 4, 2}, 4).import().meshes.at(0).triangles,
              ElementsAre(first, second));
  // What is left over is no triangle.
  EXPECT_THAT(indexed<uint32_t>({2, 1, 0, 3, 4, 2, 0}, 4).import().meshes.at(0).triangles,
              ElementsAre(first, second));
}

// glTF 2.0, 3.7.2.1: strips {i, i + (1 + i % 2), i + (2 - i % 2)}, fans {i + 1, i + 2, 0}.
TEST(ImportMeshes, UnrollsStripsAndFans) {
  EXPECT_THAT(indexed<uint16_t>({0, 1, 2, 3, 4}, 5).import().meshes.at(0).triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}, Triangle{2, 3, 4}));
  EXPECT_THAT(indexed<uint16_t>({4, 0, 1, 3}, 6).import().meshes.at(0).triangles,
              ElementsAre(Triangle{0, 1, 4}, Triangle{1, 3, 4}));
}

TEST(ImportMeshes, CountsVerticesWithoutIndices) {
  GltfFile file;
  file.add_mesh({{"POSITION", file.add_accessor(five_points, "VEC3")}}, {{"mode", 5}});
  EXPECT_THAT(file.import().meshes.at(0).triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}, Triangle{2, 3, 4}));
}

TEST(ImportMeshes, LeavesOutWhatHasTooFewIndicesWithANotice) {
  for (const int mode : {1, 2, 3, 4, 5, 6}) {
    const SceneDescription scene =
        (mode < 4 ? indexed<uint16_t>({0}, mode) : indexed<uint16_t>({0, 1}, mode)).import();
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_TRUE(has_notice(scene, "1 primitives have no positions, or too few for a line or triangle"));
  }
}

TEST(ImportMeshes, RejectsIndicesOutOfRange) {
  EXPECT_THAT(
      import_error(indexed<uint16_t>({0, 1, 5}, 4)),
      HasSubstr(
          "/meshes/0/primitives/0/indices: index 5 at position 2 is out of range, there are 5 vertices"));
  // Primitive restart values are never allowed.
  EXPECT_THAT(import_error(indexed<uint8_t>({0, 1, 2, 255, 1, 2, 3}, 5)),
              HasSubstr("index 255 at position 3"));
  EXPECT_THAT(import_error(indexed<uint16_t>({0, 1, 65535}, 4)), HasSubstr("index 65535"));
  EXPECT_THAT(import_error(indexed<uint32_t>({0, 1, 4294967295u}, 4)), HasSubstr("index 4294967295"));
  EXPECT_THAT(import_error(indexed<float>({0, 1, 2}, 4)),
              HasSubstr("expected scalars of type 5121, 5123 or 5125"));
}

TEST(ImportMeshes, RejectsPositionsThatAreNotFinite) {
  for (const float bad : {std::nanf(""), INFINITY, -INFINITY}) {
    GltfFile file;
    file.add_mesh({{"POSITION", file.add_accessor(std::vector<float>{0, 0, 0, 1, bad, 0, 0, 1, 0}, "VEC3")}});
    EXPECT_THAT(import_error(file),
                HasSubstr("/meshes/0/primitives/0/attributes/POSITION: position 1 is not finite"));
  }
}

TEST(ImportMeshes, LeavesNormalsOutWhenTheFileDoes) {
  GltfFile file;
  file.add_triangle();
  const MeshDescription mesh = file.import().meshes.at(0);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.tangents.empty());
}

TEST(ImportMeshes, RepairsNormals) {
  GltfFile file;
  const std::vector<float> normals = {0, 3, 4, 0, 0, 0, std::nanf(""), 0, 1};
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  file.add_mesh({{"POSITION", positions}, {"NORMAL", file.add_accessor(normals, "VEC3")}});
  const SceneDescription scene = file.import();
  const auto& repaired = scene.meshes.at(0).normals;
  EXPECT_NEAR(length(repaired[0] - Vec3f(0, .6f, .8f)), 0, 1e-6);
  EXPECT_EQ(repaired[1], Vec3f(0, 0, 1));
  EXPECT_EQ(repaired[2], Vec3f(0, 0, 1));
  EXPECT_TRUE(has_notice(scene, "1 vertex normals were not of unit length"));
  EXPECT_TRUE(has_notice(scene, "2 vertex normals were zero or not finite"));
}

TEST(ImportMeshes, DropsColoursThatAreAllWhite) {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  file.add_mesh(
      {{"POSITION", positions}, {"COLOR_0", file.add_accessor(std::vector<uint8_t>(12, 255), "VEC4", true)}});
  EXPECT_TRUE(file.import().meshes.at(0).colors.empty());
}

TEST(ImportMeshes, KeepsOnlyTheVerticesThatTrianglesUse) {
  GltfFile file;
  std::vector<float> positions(3000, 9.f);
  const std::vector<float> last = {0, 0, 1, 1, 0, 1, 0, 1, 1};
  std::copy(last.begin(), last.end(), positions.end() - 9);
  std::vector<float> normals(3000, 0.f);
  for (size_t i = 2; i < normals.size(); i += 3) normals[i] = 1;
  const int accessor = file.add_accessor(positions, "VEC3");
  const int normal_accessor = file.add_accessor(normals, "VEC3");
  file.add_mesh({{"POSITION", accessor}, {"NORMAL", normal_accessor}},
                {{"indices", file.add_accessor(std::vector<uint16_t>{999, 997, 998}, "SCALAR")}});
  const MeshDescription mesh = file.import().meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.normals.size(), 3u);
  EXPECT_EQ(mesh.positions[mesh.triangles.at(0)[0]], Vec3f(0, 1, 1));
  EXPECT_EQ(mesh.positions[mesh.triangles.at(0)[1]], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.positions[mesh.triangles.at(0)[2]], Vec3f(1, 0, 1));
}

}  // namespace
}  // namespace vernier::test
