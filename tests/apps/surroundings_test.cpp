// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/image/image_io.h"
#include "tests/support/process.h"

// What is around a scene that `vernier render` is told nothing of, or told something.

namespace vernier {
namespace {

using test::cornell_box;
using test::ProcessResult;
using test::run_vernier;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A triangle that fills much of the picture, its material given as JSON.
std::string triangle_scene(const test::TemporaryFolder& folder, const std::string& material) {
  return folder.write("triangle.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "extensionsUsed": ["KHR_materials_emissive_strength"],
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [)" + material + R"(],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                   "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36,
                 "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
}
const std::string plastic = R"({"pbrMetallicRoughness": {"metallicFactor": 0}})";
const std::string glowing = R"({"emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": {"metallicFactor": 0}})";
const std::string glimmering = R"({"emissiveFactor": [0.001, 0.001, 0.001]})";

struct Rendered {
  ProcessResult result;
  Image picture;
  std::string surroundings;
};

Rendered rendered(const test::TemporaryFolder& folder, const std::string& scene,
                  std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"render", scene, "-o", folder.file("out.exr"), "--progress", "none", "--size",
                             "32x24", "--spp", "4", "--stats", folder.file("out.json")});
  Rendered rendered{run_vernier(more), {}, {}};
  if (rendered.result.exit_code != 0) return rendered;
  rendered.picture = read_image(folder.file("out.exr"));
  rendered.surroundings =
      nlohmann::json::parse(test::read_file(folder.file("out.json")))["picture"]["surroundings"];
  return rendered;
}

double mean(const Image& image) {
  double sum = 0;
  for (const float value : image.values) sum += value;
  return sum / double(image.values.size());
}

TEST(Surroundings, ADarkSceneGetsTheStudioAndAWayOutOfIt) {
  const test::TemporaryFolder folder;
  for (const auto& [material, reason] :
       {std::pair(plastic, "has no light"), std::pair(glimmering, "leave it dark")}) {
    const Rendered picture = rendered(folder, triangle_scene(folder, material));
    EXPECT_EQ(picture.surroundings, "studio");
    EXPECT_THAT(picture.result.err, AllOf(HasSubstr(reason), HasSubstr("--env none")));
    EXPECT_GT(mean(picture.picture), 0.2);
    EXPECT_THAT(picture.result.err, Not(HasSubstr("black")));
  }
}

TEST(Surroundings, ASceneThatIsLitStaysAsItIs) {
  const test::TemporaryFolder folder;
  for (const auto& scene : {cornell_box, triangle_scene(folder, glowing)}) {
    const Rendered picture = rendered(folder, scene);
    EXPECT_EQ(picture.surroundings, "none");
    EXPECT_THAT(picture.result.err, Not(HasSubstr("studio")));
  }
}

TEST(Surroundings, NoneIsBlackAndSaysSo) {
  const test::TemporaryFolder folder;
  const Rendered picture = rendered(folder, triangle_scene(folder, plastic), {"--env", "none"});
  EXPECT_EQ(mean(picture.picture), 0);
  EXPECT_THAT(picture.result.err, AllOf(HasSubstr("black"), HasSubstr("--env studio")));
  const Rendered dim = rendered(folder, triangle_scene(folder, glimmering), {"--env", "none"});
  EXPECT_THAT(dim.result.err, AllOf(HasSubstr("black"), HasSubstr("--exposure 8")));
  const Rendered exposed =
      rendered(folder, triangle_scene(folder, glimmering), {"--env", "none", "--exposure", "8"});
  EXPECT_THAT(exposed.result.err, Not(HasSubstr("black")));
}

TEST(Surroundings, BuiltInOnesTurnAndScale) {
  const test::TemporaryFolder folder;
  const std::string scene = triangle_scene(folder, plastic);
  const double sky = mean(rendered(folder, scene, {"--env", "sky"}).picture);
  EXPECT_GT(sky, 0.1);
  EXPECT_NEAR(mean(rendered(folder, scene, {"--env", "sky", "--env-scale", "2"}).picture), 2 * sky,
              1e-3 * sky);
  const double studio = mean(rendered(folder, scene, {"--env", "studio"}).picture);
  EXPECT_NE(mean(rendered(folder, scene, {"--env", "studio", "--env-rotate", "150"}).picture), studio);
}

TEST(Surroundings, MisspeltNamesAndUselessFlagsAreRefused) {
  const test::TemporaryFolder folder;
  const auto refused = [&](const std::vector<std::string>& flags) {
    const ProcessResult result = rendered(folder, cornell_box, flags).result;
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
    return result.err;
  };
  EXPECT_THAT(refused({"--env", "stduio"}), HasSubstr("did you mean 'studio'"));
  EXPECT_THAT(refused({"--env-scale", "2"}), HasSubstr("need --env"));
  EXPECT_THAT(refused({"--env", "none", "--env-rotate", "2"}), HasSubstr("need --env"));
}

TEST(Surroundings, FogFillsTheAirAndSaysHowFar) {
  const test::TemporaryFolder folder;
  const std::string scene = triangle_scene(folder, plastic);
  const double clear = mean(rendered(folder, scene, {"--env", "sky"}).picture);
  const Rendered foggy = rendered(folder, scene, {"--env", "sky", "--fog", "5,0,0,3"});
  EXPECT_LT(mean(foggy.picture), 0.1 * clear);
  EXPECT_THAT(foggy.result.err, HasSubstr("fog fills a ball of 3 m"));
  EXPECT_THAT(rendered(folder, scene, {"--env", "sky", "--fog", "0.1", "--integrator", "whitted"}).result.err,
              HasSubstr("and scatters none"));
  const ProcessResult shadow =
      rendered(folder, scene, {"--env", "sky", "--fog", "0.1", "--ground", "shadow", "--transparent"}).result;
  EXPECT_EQ(shadow.exit_code, 2) << shadow.err;
  EXPECT_THAT(shadow.err, HasSubstr("none to show in fog"));
  for (const char* wrong : {"x", "-1", "0.1,foo", "0.1,2", "0.1,1,2", "0.1,1,0,0", "1,1,0,1,1", "nan"}) {
    const ProcessResult result = rendered(folder, scene, {"--fog", wrong}).result;
    EXPECT_EQ(result.exit_code, 2) << wrong;
    EXPECT_THAT(result.err, HasSubstr("expected DENSITY per metre")) << wrong;
  }
}

TEST(Surroundings, InfoTellsWhatARenderWouldUse) {
  const test::TemporaryFolder folder;
  const auto told = [](const std::string& scene) {
    return nlohmann::json::parse(run_vernier({"info", scene, "--json"}).out)["render"];
  };
  EXPECT_EQ(told(triangle_scene(folder, glimmering))["surroundings"], "studio");
  EXPECT_EQ(told(triangle_scene(folder, glimmering))["camera"], "fitted");
  EXPECT_EQ(told(cornell_box)["surroundings"], "none");
  EXPECT_THAT(run_vernier({"info", cornell_box}).out, HasSubstr("by camera front, without surroundings"));
}

TEST(Surroundings, WhatComesOutWhiteIsToldWithTheExposureThatMendsIt) {
  const test::TemporaryFolder folder;
  const std::string blazing = triangle_scene(folder, R"({"emissiveFactor": [1, 1, 1],
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 200}}})");
  const std::vector<std::string> shown{"-o", folder.file("out.png")};
  EXPECT_THAT(rendered(folder, blazing, shown).result.err,
              AllOf(HasSubstr("white"), HasSubstr("--exposure -10")));
  EXPECT_THAT(rendered(folder, blazing, {shown[0], shown[1], "--exposure", "-10"}).result.err,
              Not(HasSubstr("white")));
  EXPECT_THAT(rendered(folder, triangle_scene(folder, glowing), shown).result.err, Not(HasSubstr("white")));
  // With no exposure that the flag does not take, and not of files that have room for it.
  const std::string scene = triangle_scene(folder, R"({"emissiveFactor": [1, 1, 1],
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 1e38}}})");
  const std::vector<std::string> flags{"render", scene, "--spp", "2", "--size", "16x16", "-o"};
  const auto told = [&](const std::string& file) {
    std::vector<std::string> all = flags;
    all.push_back(folder.file(file));
    return run_vernier(all).err;
  };
  EXPECT_THAT(told("a.png"), HasSubstr("--exposure -100 darkens"));
  EXPECT_THAT(told("a.exr"), Not(HasSubstr("white")));
}

TEST(Surroundings, WhatTheStudioDoesNotLightIsTold) {
  const test::TemporaryFolder folder;
  // A tetrahedron around a camera.
  const std::string data =
      "AAAQwQAAQMAAABBBAAAQQQAAQMAAABBBAAAAAAAAQMAAABDBAAAAAAAAEEEA"
      "AAAAAAABAAIAAAABAAMAAQACAAMAAgAAAAMA";
  const std::string shut = folder.write("shut.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"camera": 0}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "materials": [{"doubleSided": true}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-9, -3, -9],
                   "max": [9, 9, 9]}, {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
    "buffers": [{"byteLength": 72,
                 "uri": "data:application/octet-stream;base64,)" +
                                                         data + R"("}]})");
  EXPECT_THAT(rendered(folder, shut).result.err, AllOf(HasSubstr("black"), HasSubstr("shut in")));
  EXPECT_THAT(rendered(folder, triangle_scene(folder, plastic), {"--exposure", "-20"}).result.err,
              AllOf(HasSubstr("black"), Not(HasSubstr("shut in"))));
}

TEST(Surroundings, RaycastNeedsNone) {
  const test::TemporaryFolder folder;
  const Rendered picture = rendered(folder, triangle_scene(folder, plastic), {"--integrator", "raycast"});
  EXPECT_THAT(picture.result.err, AllOf(Not(HasSubstr("studio")), Not(HasSubstr("black"))));
}

}  // namespace
}  // namespace vernier
