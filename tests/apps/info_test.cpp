// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/process.h"

namespace vernier {
namespace {

using test::cornell_box;
using test::two_spheres;
using testing::HasSubstr;

TEST(Info, CountsAsJson) {
  const test::ProcessResult result = test::run_vernier({"info", cornell_box, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const auto info = nlohmann::json::parse(result.out);
  EXPECT_EQ(info["counts"]["meshes"], 8);
  EXPECT_EQ(info["counts"]["triangles"], 32);
  EXPECT_EQ(info["counts"]["instanced_triangles"], 32);
  EXPECT_EQ(info["counts"]["emissive_triangles"], 2);
  EXPECT_EQ(info["hash"].get<std::string>().size(), 32u);
  EXPECT_NEAR(info["bounds"]["upper"][0], 0.556, 1e-6);
  EXPECT_NEAR(info["bounds"]["lower"][1], 0, 1e-6);
  EXPECT_EQ(info["cameras"][0]["name"], "front");
  EXPECT_NEAR(info["cameras"][0]["vertical_degrees"], 39.3077, 1e-3);
  EXPECT_NEAR(info["cameras"][0]["direction"][2], 1, 1e-6);
  EXPECT_EQ(info["materials"][3]["name"], "light");
  EXPECT_NEAR(info["materials"][3]["emissive"][0], 17, 1e-5);
  bool told = false;
  for (const auto& feature : info["features"])
    told |= feature["name"] == "KHR_materials_emissive_strength" && feature["status"] == "exact";
  EXPECT_TRUE(told) << info["features"];
}

TEST(Info, TextNamesEveryPart) {
  const test::ProcessResult result = test::run_vernier({"info", two_spheres});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* text : {"hash", "bounds", "meshes", "instances", "textures", "glass: ", "transmission 1",
                           "perspective", "KHR_materials_volume: exact"})
    EXPECT_THAT(result.out, HasSubstr(text));
}

TEST(Info, ListsTheExtensionsThatAreKnown) {
  const test::ProcessResult text = test::run_vernier({"info", "--extensions"});
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("  EXT_mesh_gpu_instancing: exact\n"));
  EXPECT_THAT(text.out, HasSubstr("  KHR_materials_dispersion: approximated, one index each"));
  EXPECT_THAT(text.out, HasSubstr("  MSFT_lod: ignored, "));
  const test::ProcessResult result = test::run_vernier({"info", "--extensions", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto list = nlohmann::json::parse(result.out);
  EXPECT_GT(list.size(), 25u);
  for (const auto& extension : list) {
    EXPECT_THAT(text.out, HasSubstr(extension["name"].get<std::string>()));
    EXPECT_TRUE(extension.contains("status") && extension.contains("note")) << extension;
  }
}

TEST(Info, InstancesAreCountedOnceStored) {
  const test::TemporaryFolder folder;
  // Three points of floats as base64: (0,0,0), (1,0,0), (0,1,0).
  const std::string scene = folder.write("twice.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 5]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                   "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36,
                 "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  const test::ProcessResult result = test::run_vernier({"info", scene, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto info = nlohmann::json::parse(result.out);
  EXPECT_EQ(info["counts"]["meshes"], 1);
  EXPECT_EQ(info["counts"]["instances"], 2);
  EXPECT_EQ(info["counts"]["triangles"], 1);
  EXPECT_EQ(info["counts"]["instanced_triangles"], 2);
  EXPECT_EQ(info["bounds"]["upper"][2], 5);
}

}  // namespace
}  // namespace vernier
