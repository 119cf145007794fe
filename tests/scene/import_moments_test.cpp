// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "scene/geometry.h"
#include "scene/scene.h"
#include "tests/scene/import_support.h"
#include "tests/support/random.h"

// How an animation becomes moments of the shutter.

namespace vernier::test {
namespace {

using testing::HasSubstr;

/// A file whose nodes are animated between 0 and 1 s.
struct AnimatedFile : GltfFile {
  AnimatedFile() {
    json["animations"] = {{{"channels", nlohmann::json::array()}, {"samplers", nlohmann::json::array()}}};
  }

  void animate(int node, const char* path, const std::vector<float>& values, const char* type) {
    const size_t width = std::string(type) == "SCALAR" ? 1 : size_t(type[3] - '0');
    std::vector<float> times;
    const size_t count = values.size() / width;
    for (size_t i = 0; i < count; ++i) times.push_back(float(i) / float(count - 1));
    auto& animation = json["animations"][0];
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation["samplers"].push_back(
        {{"input", add_accessor(times, "SCALAR")}, {"output", add_accessor(values, type)}});
  }

  SceneDescription blurred(double open = -0.5, double close = 0.5) const {
    ImportOptions options;
    options.time = 0.5;
    options.shutter = Shutter{open, close};
    return import(options);
  }
  SceneDescription at(double time) const {
    ImportOptions options;
    options.time = time;
    return import(options);
  }
};

/// Quaternion keys of a turn about z by an angle in degrees.
std::vector<float> turn(double degrees) {
  const double half = degrees / 2 * double(pi) / 180;
  return {0, 0, 0, 1, 0, 0, float(std::sin(half)), float(std::cos(half))};
}

std::string all_text(const SceneDescription& scene) {
  std::string text;
  for (const Notice& notice : scene.notices) text += notice.text + "\n";
  return text;
}

/// The farthest that a vertex of the blurred scene is from its true place, at random times.
double largest_error(const AnimatedFile& file, uint32_t instance = 0) {
  const SceneDescription blurred = file.blurred();
  const SceneGeometry moving(blurred.meshes, blurred.instances);
  Random random(3);
  double largest = 0;
  for (int i = 0; i < 100; ++i) {
    const float time = random.next1();
    const SceneDescription still = file.at(time);
    const SceneGeometry there(still.meshes, still.instances);
    for (uint32_t t = 0; t < there.triangle_count(instance); ++t)
      for (size_t k = 0; k < 3; ++k)
        largest = std::max(
            largest, double(length(moving.triangle(instance, t, time)[k] - there.triangle(instance, t)[k])));
  }
  return largest;
}

TEST(Moments, AreAsManyAsTheMotionNeeds) {
  struct Case {
    double degrees;
    size_t moments;
  };
  for (const auto& [degrees, moments] : {Case{0.5, 2}, {5, 2}, {9, 3}, {15, 5}, {170, 33}}) {
    AnimatedFile file;
    file.animate(file.add_triangle(), "rotation", turn(degrees), "VEC4");
    const SceneDescription scene = file.blurred();
    EXPECT_EQ(scene.instances[0].moments.size(), moments) << degrees;
    EXPECT_TRUE(scene.meshes[0].moments.empty());
    EXPECT_EQ(scene.instances[0].to_world, file.at(0.5).instances[0].to_world);
    EXPECT_EQ(scene.instances[0].moments.front(), file.at(0).instances[0].to_world);
    EXPECT_EQ(scene.instances[0].moments.back(), file.at(1).instances[0].to_world);
    // A thousandth of the diagonal at the moments that were looked at; hardly more between them.
    if (degrees < 100) {
      EXPECT_LE(largest_error(file), 1.3e-3 * std::sqrt(2.0)) << degrees;
    }
  }
}

TEST(Moments, OfWhatMovesAlongAreTwoAndOfWhatStandsStillNone) {
  AnimatedFile file;
  file.animate(file.add_triangle(), "translation", {0, 0, 0, 2, 1, 0}, "VEC3");
  file.add_triangle();
  file.animate(file.add_triangle(), "translation", {3, 0, 0, 3, 0, 0}, "VEC3");
  const SceneDescription scene = file.blurred();
  EXPECT_EQ(scene.instances[0].moments.size(), 2u);
  EXPECT_TRUE(scene.instances[1].moments.empty());
  EXPECT_TRUE(scene.instances[2].moments.empty());
  EXPECT_THAT(all_text(scene), HasSubstr("1 of 3 instances move while the shutter is open, 0 of them"));
  EXPECT_LE(largest_error(file), 1e-5);
}

TEST(Moments, AreThoseOfTheAnimationWithoutAShutter) {
  AnimatedFile file;
  file.animate(file.add_triangle(), "translation", {0, 0, 0, 2, 1, 0}, "VEC3");
  EXPECT_TRUE(file.at(0.5).instances[0].moments.empty());
  ImportOptions options;
  options.shutter = Shutter{-0.1, 0.1};
  EXPECT_TRUE(file.import(options).instances[0].moments.empty()) << "at rest";
}

TEST(Moments, OfAMorphAreShapesOfItsOwnMesh) {
  AnimatedFile file;
  const int offsets = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 2, 1}, "VEC3");
  const int node = file.add_triangle({{"targets", {{{"POSITION", offsets}}}}});
  file.add_root({{"mesh", 0}});
  file.animate(node, "weights", {0, 1, 0.5f}, "SCALAR");
  const SceneDescription scene = file.blurred();
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_NE(scene.instances[0].mesh, scene.instances[1].mesh);
  EXPECT_EQ(scene.meshes[scene.instances[0].mesh].moments.size(), 3u);
  EXPECT_TRUE(scene.meshes[scene.instances[1].mesh].moments.empty());
  EXPECT_LE(largest_error(file), 1e-5);
}

TEST(Moments, OfASkinFollowItsJoints) {
  AnimatedFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int joints = file.add_accessor(std::vector<uint8_t>(12, 0), "VEC4");
  const int weights = file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const int skinned = file.add_mesh({{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
  const int joint = file.add_root({{"name", "joint"}});
  file.add("skins", {{"joints", {joint}}});
  file.json["nodes"][size_t(skinned)]["skin"] = 0;
  file.animate(joint, "rotation", turn(20), "VEC4");
  EXPECT_EQ(file.blurred().meshes[0].moments.size(), 5u);
  EXPECT_LE(largest_error(file), 1.3e-3 * std::sqrt(2.0));
}

TEST(Moments, OfDerivedTangentsHaveCornersOfTheirOwn) {
  AnimatedFile file;
  file.add("images", {{"uri",
                       "data:image/"
                       "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+"
                       "M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}});
  file.add("textures", {{"source", 0}});
  file.add("materials", {{"normalTexture", {{"index", 0}}}});
  const int positions = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
  const int normals = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int texcoords = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1}, "VEC2");
  const int offsets = file.add_accessor(std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0, 0, 0.5f, 0.5f, 1}, "VEC3");
  const int indices = file.add_accessor(std::vector<uint16_t>{0, 1, 2, 2, 1, 3}, "SCALAR");
  const int node =
      file.add_mesh({{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", texcoords}},
                    {{"material", 0}, {"indices", indices}, {"targets", {{{"POSITION", offsets}}}}});
  file.animate(node, "weights", {0, 1}, "SCALAR");
  const SceneDescription scene = file.blurred();
  const MeshDescription& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.moments.size(), 2u);
  EXPECT_EQ(mesh.positions.size(), 3 * mesh.triangles.size());
  EXPECT_EQ(mesh.moments[1].tangents.size(), mesh.positions.size());
  EXPECT_LE(largest_error(file), 1e-5);
}

TEST(Moments, OfCamerasAndLampsAreTheirFrames) {
  AnimatedFile file;
  file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  const int camera = file.add_root({{"camera", 0}});
  const int lamp = file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  file.add_root({{"camera", 0}});
  file.add_triangle();
  file.animate(camera, "rotation", turn(20), "VEC4");
  file.animate(lamp, "translation", {0, 0, 0, 1, 0, 0}, "VEC3");
  const SceneDescription scene = file.blurred();
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_GE(scene.cameras[0].moments.size(), 3u);
  EXPECT_EQ(scene.cameras[0].moments.back(), file.at(1).cameras[0].to_world);
  EXPECT_TRUE(scene.cameras[1].moments.empty());
  ASSERT_EQ(scene.lights[0].moments.size(), 2u);
  EXPECT_EQ(scene.lights[0].moments[1].origin, Vec3f(1, 0, 0));
  EXPECT_FALSE(SceneGeometry(scene.meshes, scene.instances).moves());
  EXPECT_TRUE(Scene(scene, {}).moves());
}

TEST(Moments, AreNoneOfWhatTurnsInsideOut) {
  AnimatedFile file;
  file.animate(file.add_triangle(), "scale", {1, 1, 1, -1, 1, 1}, "VEC3");
  const SceneDescription scene = file.blurred();
  EXPECT_TRUE(scene.instances[0].moments.empty());
  EXPECT_THAT(all_text(scene), HasSubstr("1 instances stand still"));
}

TEST(Moments, ThatThereCannotBeAreRefused) {
  const AnimatedFile file = [] {
    AnimatedFile made;
    made.animate(made.add_triangle(), "translation", {0, 0, 0, 2, 1, 0}, "VEC3");
    return made;
  }();
  const auto refused = [](const SceneDescription& scene) -> std::string {
    try {
      build_scene(scene);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  SceneDescription scene = file.blurred();
  EXPECT_EQ(refused(scene), "");
  scene.instances[0].moments.resize(4);
  EXPECT_THAT(refused(scene), HasSubstr("has 4 moments; expected 2, 3, 5"));
  scene = file.blurred();
  scene.instances[0].moments[1].x = {-1, 0, 0};
  EXPECT_THAT(refused(scene), HasSubstr("mirrors its mesh at some moments only"));
  scene = file.blurred();
  scene.meshes[0].moments.resize(2);
  EXPECT_THAT(refused(scene), HasSubstr("other numbers of positions"));
}

}  // namespace
}  // namespace vernier::test
