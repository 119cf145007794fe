// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/scene/import_support.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

GltfFile triangle() {
  GltfFile file;
  file.add_triangle({{"material", 0}});
  file.add("materials", json::object());
  return file;
}

/// What importing says after the value at a JSON pointer was set.
std::string error_with(const std::string& pointer, const json& value) {
  GltfFile file = triangle();
  file.json[json::json_pointer(pointer)] = value;
  return import_error(file);
}

TEST(ImportSchema, AcceptsTheUnchangedFile) { EXPECT_THAT(import_error(triangle()), IsEmpty()); }

TEST(ImportSchema, NamesWrongTypesByPointer) {
  EXPECT_THAT(error_with("/scene", "hello"),
              HasSubstr("/scene: expected an integer from 0 to 0, found \"hello\""));
  EXPECT_THAT(error_with("/skins", json::object()), HasSubstr("/skins: expected an array, found an object"));
  EXPECT_THAT(error_with("/meshes/0/primitives/0", 3),
              HasSubstr("/meshes/0/primitives/0: expected an object, found 3"));
  EXPECT_THAT(error_with("/materials/0/doubleSided", 1),
              HasSubstr("/materials/0/doubleSided: expected true or false"));
  EXPECT_THAT(error_with("/nodes/0/name", 42), HasSubstr("/nodes/0/name: expected a string, found 42"));
  EXPECT_THAT(error_with("/nodes/0/children", 1), HasSubstr("/nodes/0/children: expected an array, found 1"));
  EXPECT_THAT(error_with("/nodes/0/extensions", {{"KHR_lights_punctual", 1}}),
              HasSubstr("/nodes/0/extensions/KHR_lights_punctual: expected an object"));
}

TEST(ImportSchema, ChecksLengthsOfArrays) {
  EXPECT_THAT(error_with("/nodes/0/matrix", json(std::vector<double>(17, 0.0))),
              HasSubstr("/nodes/0/matrix: expected 16 items, found an array of 17"));
  EXPECT_THAT(error_with("/nodes/0/rotation", {0, 0, 1}), HasSubstr("/nodes/0/rotation: expected 4 items"));
  EXPECT_THAT(error_with("/nodes/0/scale", {1, "a", 1}),
              HasSubstr("/nodes/0/scale/1: expected a number, found \"a\""));
}

TEST(ImportSchema, ChecksIndices) {
  EXPECT_THAT(error_with("/nodes/0/mesh", 1),
              HasSubstr("/nodes/0/mesh: expected an integer from 0 to 0, found 1"));
  EXPECT_THAT(error_with("/nodes/0/mesh", -1), HasSubstr("found -1"));
  EXPECT_THAT(error_with("/nodes/0/mesh", 4294967296), HasSubstr("found 4294967296"));
  EXPECT_THAT(error_with("/nodes/0/skin", 0),
              HasSubstr("/nodes/0/skin: /skins, which it refers to, is missing"));
  EXPECT_THAT(error_with("/accessors/0/bufferView", 9), HasSubstr("/accessors/0/bufferView"));
  EXPECT_THAT(error_with("/meshes/0/primitives/0/attributes/NORMAL", 9), HasSubstr("/attributes/NORMAL"));
  EXPECT_THAT(error_with("/materials/0/normalTexture", {{"index", 0}}),
              HasSubstr("/normalTexture/index: /textures"));
}

TEST(ImportSchema, ChecksValuesThereAre) {
  EXPECT_THAT(error_with("/accessors/0/componentType", 5124), HasSubstr("expected one of 5120, 5121"));
  EXPECT_THAT(error_with("/accessors/0/type", "VEC5"), HasSubstr("expected one of SCALAR, VEC2"));
  EXPECT_THAT(error_with("/meshes/0/primitives/0/mode", 7), HasSubstr("expected an integer from 0 to 6"));
}

TEST(ImportSchema, TakesWholeNumbersWithADecimalPoint) {
  EXPECT_THAT(error_with("/accessors/0/count", 3.0), IsEmpty());
  EXPECT_THAT(error_with("/accessors/0/componentType", 5126.0), IsEmpty());
  EXPECT_THAT(error_with("/accessors/0/count", 2.5), HasSubstr("expected an integer"));
}

TEST(ImportSchema, RefusesSizesThatWrap) {
  for (const uint64_t count : {uint64_t{1} << 62, uint64_t{1} << 61, ~uint64_t{0}})
    EXPECT_THAT(error_with("/accessors/0/count", count), HasSubstr("/accessors/0/count")) << count;
  EXPECT_THAT(error_with("/accessors/0/count", uint64_t{1} << 52), HasSubstr("/accessors/0: "));
  EXPECT_THAT(error_with("/accessors/0/count", 0), HasSubstr("/accessors/0/count: expected an integer"));
  EXPECT_THAT(error_with("/accessors/0/byteOffset", uint64_t{1} << 52), HasSubstr("/accessors/0: "));
  EXPECT_THAT(error_with("/bufferViews/0/byteLength", uint64_t{1} << 52), HasSubstr("/bufferViews/0: "));
  EXPECT_THAT(error_with("/bufferViews/0/byteOffset", uint64_t{1} << 53), HasSubstr("/bufferViews/0: "));
  EXPECT_THAT(error_with("/bufferViews/0/byteOffset", -4), HasSubstr("/bufferViews/0/byteOffset"));
}

TEST(ImportSchema, NamesMissingProperties) {
  GltfFile file = triangle();
  file.json["accessors"][0].erase("count");
  EXPECT_THAT(import_error(file), HasSubstr("/accessors/0: 'count' is missing"));
  file = triangle();
  file.json.erase("asset");
  EXPECT_THAT(import_error(file), HasSubstr("/: 'asset' is missing"));
}

TEST(ImportSchema, LeavesExtrasAndUnknownExtensionsAlone) {
  EXPECT_THAT(error_with("/extras", {{"anything", {1, nullptr, "x"}}}), IsEmpty());
  EXPECT_THAT(error_with("/nodes/0/extensions", {{"VENDOR_thing", {{"mesh", "no"}}}}), IsEmpty());
}

}  // namespace
}  // namespace vernier::test
