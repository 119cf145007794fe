// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/scene/import_support.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Imports a triangle with those colours or texture coordinates.
template <typename T>
MeshDescription with_attribute(const std::string& name, const std::vector<T>& values, const std::string& type,
                               bool normalized) {
  GltfFile file;
  json attributes = {{"POSITION", file.add_accessor(GltfFile::triangle_positions(), "VEC3")}};
  attributes[name] = file.add_accessor(values, type, normalized);
  file.add_mesh(attributes);
  return file.import().meshes.at(0);
}

template <typename T>
MeshDescription with_positions(const std::vector<T>& values, bool normalized) {
  GltfFile file;
  file.add_mesh({{"POSITION", file.add_accessor(values, "VEC3", normalized)}});
  return file.import().meshes.at(0);
}

// glTF 2.0, 3.6.2.3: c / 255, max(c / 127, -1), c / 65535, max(c / 32767, -1).
TEST(ImportAccessors, MapsNormalisedIntegers) {
  EXPECT_EQ(
      with_attribute<uint8_t>("COLOR_0", {0, 51, 255, 255, 1, 2, 3, 4, 9, 9, 9, 9}, "VEC4", true).colors[0],
      Vec4f(0, 51 / 255.f, 1, 1));
  EXPECT_EQ(with_attribute<uint16_t>("COLOR_0", {0, 13107, 65535, 7, 1, 2, 3, 4, 9, 9, 9, 9}, "VEC4", true)
                .colors[0],
            Vec4f(0, 0.2f, 1, 7 / 65535.f));
  const MeshDescription bytes = with_positions<int8_t>({-128, -127, 0, 127, 1, -1, 0, 0, 64}, true);
  EXPECT_EQ(bytes.positions[0], Vec3f(-1, -1, 0));
  EXPECT_EQ(bytes.positions[1], Vec3f(1, 1 / 127.f, -1 / 127.f));
  const MeshDescription shorts = with_positions<int16_t>({-32768, -32767, 0, 32767, 1, -1, 0, 0, 64}, true);
  EXPECT_EQ(shorts.positions[0], Vec3f(-1, -1, 0));
  EXPECT_EQ(shorts.positions[1], Vec3f(1, 1 / 32767.f, -1 / 32767.f));
}

TEST(ImportAccessors, KeepsTheValueOfOtherIntegers) {
  EXPECT_EQ(with_positions<int8_t>({-128, 0, 127, 1, 2, 3, 4, 5, 6}, false).positions[0],
            Vec3f(-128, 0, 127));
  EXPECT_EQ(with_positions<uint8_t>({255, 0, 127, 1, 2, 3, 4, 5, 6}, false).positions[0], Vec3f(255, 0, 127));
  EXPECT_EQ(with_positions<int16_t>({-32768, 0, 1, 1, 2, 3, 4, 5, 6}, false).positions[0],
            Vec3f(-32768, 0, 1));
  EXPECT_EQ(with_positions<uint16_t>({65535, 0, 1, 1, 2, 3, 4, 5, 6}, false).positions[0],
            Vec3f(65535, 0, 1));
  EXPECT_EQ(with_positions<uint32_t>({1 << 24, 0, 1, 1, 2, 3, 4, 5, 6}, false).positions[0],
            Vec3f(1 << 24, 0, 1));
}

TEST(ImportAccessors, GivesRgbColoursAnAlphaOfOne) {
  const auto mesh = with_attribute<float>("COLOR_0", {.1f, .2f, .3f, 1, 1, 1, 0, 0, 0}, "VEC3", false);
  EXPECT_EQ(mesh.colors[0], Vec4f(.1f, .2f, .3f, 1));
}

TEST(ImportAccessors, FollowsStridesAndOffsets) {
  GltfFile file;
  // Two interleaved attributes of 20 bytes a vertex, after 8 bytes of something else.
  const std::vector<float> data = {7, 7, 0, 0, 0, .1f, .2f, 1, 0, 0, .3f, .4f, 0, 1, 0, .5f, .6f};
  const int view = file.add_view(data, {{"byteStride", 20}});
  file.json["bufferViews"][0]["byteOffset"] = 8;
  file.json["bufferViews"][0]["byteLength"] = 60;
  const auto attribute = [&](size_t offset, const char* type) {
    return file.add("accessors", {{"bufferView", view},
                                  {"byteOffset", offset},
                                  {"componentType", 5126},
                                  {"count", 3},
                                  {"type", type}});
  };
  const int positions = attribute(0, "VEC3"), texcoords = attribute(12, "VEC2");
  file.add("images", {{"uri", "data:,x"}});
  file.add("textures", {{"source", 0}});
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  file.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", texcoords}}, {{"material", 0}});
  const SceneDescription scene = file.import();
  EXPECT_EQ(scene.meshes.at(0).positions[2], Vec3f(0, 1, 0));
  EXPECT_EQ(scene.meshes.at(0).texcoords[0].at(1), Vec2f(.3f, .4f));
  // The last element ends with the view; one byte less does not hold it.
  file.json["bufferViews"][0]["byteLength"] = 59;
  EXPECT_THAT(import_error(file), HasSubstr("/accessors/1: 3 elements need 48 bytes from byte 12 on"));
}

TEST(ImportAccessors, SubstitutesSparseElements) {
  for (const bool has_base : {true, false}) {
    GltfFile file;
    const int accessor = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
    const int indices = file.add_view(std::vector<uint16_t>{1, 2});
    const int values = file.add_view(std::vector<float>{5, 6, 7, 8, 9, 10});
    json& object = file.json["accessors"][size_t(accessor)];
    object["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                        {"values", {{"bufferView", values}}}};
    if (!has_base) object.erase("bufferView");
    file.add_mesh({{"POSITION", accessor}});
    const MeshDescription mesh = file.import().meshes.at(0);
    EXPECT_EQ(mesh.positions[0], Vec3f(0, 0, 0));
    EXPECT_EQ(mesh.positions[1], Vec3f(5, 6, 7));
    EXPECT_EQ(mesh.positions[2], Vec3f(8, 9, 10));
  }
}

TEST(ImportAccessors, RejectsSparseIndicesOutOfRange) {
  GltfFile file;
  const int accessor = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int indices = file.add_view(std::vector<uint32_t>{3});
  const int values = file.add_view(std::vector<float>{5, 6, 7});
  file.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5125}}},
                                         {"values", {{"bufferView", values}}}};
  file.add_mesh({{"POSITION", accessor}});
  EXPECT_THAT(import_error(file),
              HasSubstr("/accessors/0/sparse/indices: sparse index 3 of an accessor of 3"));
  file.json["accessors"][0]["sparse"]["count"] = 2;
  EXPECT_THAT(import_error(file), HasSubstr("/accessors/0/sparse/indices: 2 elements need 8 bytes"));
}

TEST(ImportAccessors, ReadsZerosWithoutABufferView) {
  GltfFile file;
  const int accessor = file.add("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  file.add_mesh({{"POSITION", accessor}});
  EXPECT_EQ(file.import().meshes.at(0).positions[2], Vec3f(0, 0, 0));
  file.json["accessors"][0]["count"] = 4000000000;
  EXPECT_THAT(import_error(file), HasSubstr("/accessors/0/count: 4000000000 elements without a bufferView"));
}

/// A file of some hundred bytes would ask for gigabytes, of instances above all.
TEST(ImportAccessors, ReadsFewZerosForASmallFileAndMoreForALargeOne) {
  GltfFile file;
  const int accessor = file.add("accessors", {{"componentType", 5126}, {"count", 3000000}, {"type", "VEC3"}});
  file.add_mesh({{"POSITION", accessor}});
  EXPECT_THAT(import_error(file),
              HasSubstr("3000000 elements without a bufferView; at most 524288 are read"));
  file.add_view(std::vector<uint8_t>(3000000));
  EXPECT_EQ(import_error(file), "");
}

TEST(ImportAccessors, ChecksTypesAndCounts) {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int pairs = file.add_accessor(std::vector<float>{0, 0, 1, 1, 2, 2}, "VEC2");
  const int two = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC3");
  file.add_mesh({{"POSITION", positions}, {"NORMAL", pairs}});
  EXPECT_THAT(import_error(file),
              HasSubstr("/meshes/0/primitives/0/attributes/NORMAL: expected 3 components, found 2"));
  file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = two;
  EXPECT_THAT(import_error(file), HasSubstr("/attributes/NORMAL: 2 values for 3 positions"));
}

}  // namespace
}  // namespace vernier::test
