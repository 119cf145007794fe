// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/scene/import_support.h"

namespace vernier::test {
namespace {

using nlohmann::json;

constexpr const char* pixel =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";

/// Meshes of the same `vertices` points, one for each of five materials, the last of which reads other
/// texture coordinates than the rest.
GltfFile in_many_colors(int vertices) {
  GltfFile file;
  const auto zeros = [&](const char* type) {
    return file.add("accessors", {{"componentType", 5126}, {"count", vertices}, {"type", type}});
  };
  const json attributes = {
      {"POSITION", zeros("VEC3")}, {"TEXCOORD_0", zeros("VEC2")}, {"TEXCOORD_1", zeros("VEC2")}};
  file.add("images", {{"uri", pixel}});
  file.add("textures", {{"source", 0}});
  for (int i = 0; i < 5; ++i) {
    const int material = file.add(
        "materials",
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", i == 4 ? 1 : 0}}}}}});
    file.add_mesh(attributes, {{"material", material}});
  }
  return file;
}

TEST(ImportAlike, LargeShapesAreKeptOnceForManyMaterials) {
  const SceneDescription scene = in_many_colors(400000).import();
  ASSERT_EQ(scene.instances.size(), 5u);
  EXPECT_EQ(scene.meshes.size(), 2u) << "one for each set of texture coordinates that is read";
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(scene.instances[i].material, i);
    EXPECT_EQ(scene.instances[i].mesh, i == 4 ? 1u : 0u);
  }
}

TEST(ImportAlike, SmallShapesArePlacedOnceEach) {
  EXPECT_EQ(in_many_colors(3).import().meshes.size(), 5u) << "rays meet them sooner so";
}

TEST(ImportAlike, OtherIndicesMakeAnotherShape) {
  GltfFile file = in_many_colors(400000);
  file.json["meshes"][0]["primitives"][0]["indices"] =
      file.add_accessor(std::vector<uint32_t>{0, 1, 2}, "SCALAR");
  EXPECT_EQ(file.import().meshes.size(), 3u);
}

TEST(ImportAlike, OtherMorphWeightsMakeAnotherShape) {
  GltfFile file = in_many_colors(400000);
  for (auto& mesh : file.json["meshes"]) {
    mesh["primitives"][0]["targets"] = {{{"POSITION", 0}}};
    mesh["weights"] = {0.5};
  }
  EXPECT_EQ(file.import().meshes.size(), 2u);
  file.json["meshes"][1]["weights"] = {0.25};
  EXPECT_EQ(file.import().meshes.size(), 3u);
}

}  // namespace
}  // namespace vernier::test
