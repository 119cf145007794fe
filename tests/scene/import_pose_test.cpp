// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "tests/scene/import_support.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

void expect_near(const Vec3f& actual, const Vec3f& expected) {
  EXPECT_NEAR(length(actual - expected), 0, 1e-5) << actual << " is not " << expected;
}

/// The triangle on a node that one channel animates.
GltfFile animated(const std::string& path, const std::vector<float>& times, const std::vector<float>& values,
                  const std::string& type, const std::string& interpolation) {
  GltfFile file;
  const int node = file.add_triangle();
  const int input = file.add_accessor(times, "SCALAR"), output = file.add_accessor(values, type);
  file.add("animations",
           {{"name", "move"},
            {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}},
            {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}});
  return file;
}

Transform at(const GltfFile& file, double time) {
  ImportOptions options;
  options.time = time;
  return file.import(options).instances.at(0).to_world;
}

TEST(ImportPose, InterpolatesLinearlyAndHoldsTheEnds) {
  const GltfFile file = animated("translation", {1, 3}, {0, 0, 0, 4, 8, 0}, "VEC3", "LINEAR");
  expect_near(at(file, 0).origin, {0, 0, 0});
  expect_near(at(file, 1.5).origin, {1, 2, 0});
  expect_near(at(file, 3).origin, {4, 8, 0});
  expect_near(at(file, 9).origin, {4, 8, 0});
}

TEST(ImportPose, StaysAtRestWithoutATime) {
  const GltfFile file = animated("translation", {0}, {5, 5, 5}, "VEC3", "LINEAR");
  expect_near(file.import().instances.at(0).to_world.origin, {0, 0, 0});
  expect_near(at(file, 0).origin, {5, 5, 5});
}

TEST(ImportPose, Steps) {
  const GltfFile file = animated("scale", {0, 1}, {1, 1, 1, 2, 3, 4}, "VEC3", "STEP");
  expect_near(at(file, 0.999).point({1, 1, 1}), {1, 1, 1});
  expect_near(at(file, 1).point({1, 1, 1}), {2, 3, 4});
}

TEST(ImportPose, JumpsWhereKeysShareATime) {
  const GltfFile file =
      animated("translation", {0, 1, 1, 2}, {0, 0, 0, 1, 0, 0, 5, 0, 0, 6, 0, 0}, "VEC3", "LINEAR");
  expect_near(at(file, 0.5).origin, {0.5, 0, 0});
  expect_near(at(file, 1).origin, {5, 0, 0});
  expect_near(at(file, 1.5).origin, {5.5, 0, 0});
  ImportOptions options;
  options.time = 0;
  EXPECT_TRUE(has_notice(file.import(options), "keys share a time"));
}

TEST(ImportPose, TurnsAlongTheShorterArc) {
  const float s = std::sqrt(0.5f);
  // A quarter turn about z, its second key written as the opposite quaternion.
  const GltfFile file = animated("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, -s, -s}, "VEC4", "LINEAR");
  expect_near(at(file, 0.5).x, {s, s, 0});
  expect_near(at(file, 1).x, {0, 1, 0});
}

// glTF 2.0, appendix C.5: p(t) of a Hermite spline whose tangents are scaled by the key distance.
TEST(ImportPose, FollowsCubicSplines) {
  const std::vector<float> values = {0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
  const GltfFile file = animated("translation", {0, 2}, values, "VEC3", "CUBICSPLINE");
  const double t = 0.25;
  const double expected = 2 * (t * t * t - 2 * t * t + t) * 3 + (3 * t * t - 2 * t * t * t) * 1;
  expect_near(at(file, 0.5).origin, {float(expected), 0, 0});
  expect_near(at(file, 2).origin, {1, 0, 0});
}

TEST(ImportPose, ChoosesAnimationsByNameOrIndex) {
  GltfFile file = animated("translation", {0}, {1, 0, 0}, "VEC3", "LINEAR");
  json second = file.json["animations"][0];
  second["name"] = "jump";
  second["channels"][0]["target"]["path"] = "scale";
  file.add("animations", second);
  ImportOptions options;
  options.time = 0;
  options.animation = "jump";
  expect_near(file.import(options).instances.at(0).to_world.x, {1, 0, 0});
  expect_near(file.import(options).instances.at(0).to_world.y, {0, 0, 0});
  options.time.reset();
  expect_near(file.import(options).instances.at(0).to_world.y, {0, 0, 0});
  options.animation = "0";
  expect_near(file.import(options).instances.at(0).to_world.origin, {1, 0, 0});
  options.animation = "run";
  EXPECT_THAT(import_error(file, options), HasSubstr("unknown animation 'run'; there are: move, jump"));
  file.json.erase("animations");
  EXPECT_THAT(import_error(file, options), HasSubstr("the file has no animation"));
}

TEST(ImportPose, RejectsBadTracks) {
  ImportOptions options;
  options.time = 0;
  EXPECT_THAT(import_error(animated("translation", {1, 0.5}, {0, 0, 0, 1, 1, 1}, "VEC3", "LINEAR"), options),
              HasSubstr("/animations/0/samplers/0/input: time 1 is not after the one before"));
  EXPECT_THAT(import_error(animated("translation", {0, 1}, {0, 0, 0}, "VEC3", "LINEAR"), options),
              HasSubstr("/animations/0/samplers/0/output"));
  EXPECT_THAT(import_error(animated("scale", {0}, {1, std::nanf(""), 1}, "VEC3", "LINEAR"), options),
              HasSubstr("/animations/0/samplers/0/output: the value is not finite"));
  EXPECT_THAT(import_error(animated("rotation", {0}, {0, 0, 0}, "VEC3", "LINEAR"), options),
              HasSubstr("expected 4 values a key, found 3"));
  GltfFile file = animated("translation", {0}, {0, 0, 0}, "VEC3", "LINEAR");
  file.json["animations"][0]["channels"][0]["sampler"] = 1;
  EXPECT_THAT(import_error(file, options), HasSubstr("a channel uses sampler 1 of 1"));
}

TEST(ImportPose, Morphs) {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int normals = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int lift = file.add_accessor(std::vector<float>{0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3");
  const int tilt = file.add_accessor(std::vector<float>{1, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  const int node = file.add_mesh({{"POSITION", positions}, {"NORMAL", normals}},
                                 {{"targets", {{{"POSITION", lift}}, {{"NORMAL", tilt}}}}});
  EXPECT_EQ(file.import().meshes.at(0).positions[0], Vec3f(0, 0, 0));
  file.json["meshes"][0]["weights"] = {0.5, 0};
  EXPECT_EQ(file.import().meshes.at(0).positions[0], Vec3f(0, 0, 1));
  file.json["nodes"][size_t(node)]["weights"] = {0, 1};
  const MeshDescription mesh = file.import().meshes.at(0);
  EXPECT_EQ(mesh.positions[0], Vec3f(0, 0, 0)) << "a node's weights stand for the mesh's";
  expect_near(mesh.normals[0], Vec3f(std::sqrt(0.5f), 0, std::sqrt(0.5f)));
  expect_near(mesh.normals[1], Vec3f(0, 0, 1));

  // Two nodes of different weights are two shapes; a third like the first is not another.
  file.add_root({{"mesh", 0}});
  file.add_root({{"mesh", 0}});
  const SceneDescription scene = file.import();
  EXPECT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.instances[1].mesh, scene.instances[2].mesh);
}

/// The triangle bound to two joints: vertices 0 and 1 to one each, vertex 2 to both.
GltfFile skinned() {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int normals = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int joints = file.add_accessor(std::vector<uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
  const int weights = file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0}, "VEC4");
  file.add_mesh({{"POSITION", positions}, {"NORMAL", normals}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
  const int first = file.add_root({{"translation", {0, 0, 10}}});
  const int second = file.add_root({{"translation", {0, 4, 0}}, {"scale", {2, 2, 2}}});
  file.add("skins", {{"joints", {first, second}}});
  file.json["nodes"][0]["skin"] = 0;
  file.json["nodes"][0]["translation"] = {100, 100, 100};  // does not count
  return file;
}

TEST(ImportPose, Skins) {
  const SceneDescription scene = skinned().import();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE(scene.instances[0].to_world.is_identity());
  const MeshDescription& mesh = scene.meshes.at(0);
  expect_near(mesh.positions[0], {0, 0, 10});
  expect_near(mesh.positions[1], {2, 4, 0});
  expect_near(mesh.positions[2], {0, 3.5f, 5});
  expect_near(mesh.normals[1], {0, 0, 1});
}

TEST(ImportPose, AppliesInverseBindMatrices) {
  GltfFile file = skinned();
  std::vector<float> matrices(32, 0.f);
  for (size_t m = 0; m < 2; ++m)
    for (size_t i = 0; i < 4; ++i) matrices[16 * m + 5 * i] = 1;
  matrices[14] = -10;      // undoes the first joint's translation
  matrices[16 + 12] = -1;  // before the second joint's scale
  file.json["skins"][0]["inverseBindMatrices"] = file.add_accessor(matrices, "MAT4");
  const auto positions = file.import().meshes.at(0).positions;
  expect_near(positions[0], {0, 0, 0});
  expect_near(positions[1], {0, 4, 0});
  file.json["accessors"].back()["count"] = 1;
  EXPECT_THAT(import_error(file), HasSubstr("/skins/0/inverseBindMatrices: 1 matrices for 2 joints"));
}

TEST(ImportPose, RejectsJointsOutOfRange) {
  GltfFile file = skinned();
  file.json["skins"][0]["joints"] = {1};
  EXPECT_THAT(import_error(file), HasSubstr("/attributes/JOINTS_0: joint 1 of a skin of 1"));
  file.json["meshes"][0]["primitives"][0]["attributes"].erase("JOINTS_0");
  EXPECT_THAT(import_error(file), HasSubstr("needs JOINTS_0 and WEIGHTS_0"));
}

}  // namespace
}  // namespace vernier::test
