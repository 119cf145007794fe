// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/scene/import_support.h"
#include "tests/support/effort.h"
#include "tests/support/statistics.h"
#include "vernier/scene_file.h"
#include "vernier/session.h"

// A blurred picture is the mean of pictures at many instants. Those are of scenes that stand still, posed by
// the importer at each instant, so that nothing of what makes moments is in them.

namespace vernier::test {
namespace {

constexpr int width = 12, height = 8, sets = 16;
constexpr double shutter_seconds = 0.5;

/// A box about the origin.
int add_box(GltfFile& file, const Vec3f& half, nlohmann::json primitive) {
  std::vector<float> positions;
  for (int i = 0; i < 8; ++i)
    positions.insert(positions.end(),
                     {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
  const std::vector<uint16_t> indices{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                      2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  primitive["indices"] = file.add_accessor(indices, "SCALAR");
  primitive["attributes"] = {{"POSITION", file.add_accessor(positions, "VEC3")}};
  return file.add("meshes", {{"primitives", {primitive}}});
}

int add_material(GltfFile& file, double base, double glow = 0) {
  return file.add("materials", {{"pbrMetallicRoughness",
                                 {{"baseColorFactor", {base, base, base, 1}}, {"metallicFactor", 0}}},
                                {"emissiveFactor", {glow, glow, glow}}});
}

/// Two keys a half second apart of one property of a node.
void animate(GltfFile& file, int node, const char* path, const std::vector<float>& values, const char* type) {
  const size_t keys = values.size() / (std::string(type) == "VEC4" ? 4 : std::string(type) == "VEC3" ? 3 : 1);
  std::vector<float> times;
  for (size_t i = 0; i < keys; ++i) times.push_back(float(shutter_seconds * double(i) / double(keys - 1)));
  auto& animations = file.json["animations"];
  if (animations.is_null())
    animations = {{{"channels", nlohmann::json::array()}, {"samplers", nlohmann::json::array()}}};
  auto& animation = animations[0];
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  animation["samplers"].push_back(
      {{"input", file.add_accessor(times, "SCALAR")}, {"output", file.add_accessor(values, type)}});
}

/// A camera five metres off and a lamp of 40 W/sr above it.
struct Stage {
  GltfFile file;
  int camera, lamp;

  Stage() {
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    camera = file.add_root({{"camera", 0}, {"translation", {0, 0, 5}}});
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 300}}};
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    lamp = file.add_root(
        {{"translation", {1, 3, 4}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const int floor = add_box(file, {5, 0.1f, 5}, {{"material", add_material(file, 0.6)}});
    file.add_root({{"mesh", floor}, {"translation", {0, -1.2, 0}}});
  }
  int add_node(int mesh, nlohmann::json node = nlohmann::json::object()) {
    node["mesh"] = mesh;
    return file.add_root(std::move(node));
  }
};

std::vector<float> quarter_turn_about_z() { return {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f}; }

/// Radiance of each pixel in `sets` independent pictures.
class Pictures {
 public:
  Pictures() : pixels_(size_t(width) * height) {}
  void add(int set, const Image& picture, double weight) {
    for (size_t i = 0; i < pixels_.size(); ++i)
      pixels_[i][size_t(set)] += weight * double(picture.values[i * size_t(picture.channels)]);
  }
  Samples at(size_t pixel) const {
    Samples samples;
    for (const double value : pixels_[pixel]) samples.add(value);
    return samples;
  }
  size_t size() const { return pixels_.size(); }

 private:
  std::vector<std::array<double, sets>> pixels_;
};

void render(const SceneDescription& description, RenderSettings settings, uint64_t seed, double weight,
            Pictures& pictures) {
  const auto scene = build_scene(description);
  settings.camera = description.cameras.at(0);
  for (int set = 0; set < sets; ++set) {
    settings.seed = seed * sets + uint64_t(set);
    RenderSession session(scene, settings);
    session.run();
    pictures.add(set, *session.picture().single("R"), weight);
  }
}

RenderSettings small_picture(int spp) {
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  settings.adaptive = false;
  settings.limits.spp = spp;
  settings.integrator_options.max_depth = 3;
  return settings;
}

/// The family of all pixels, and of all such tests of this file, at one in ten thousand.
void expect_mean_of_instants(const GltfFile& gltf, RenderSettings settings = small_picture(0)) {
  const std::string bytes = gltf.glb();
  SceneFile file("scene.glb", std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()));
  constexpr int instants = 256;
  Pictures blurred, mean;
  ImportOptions options;
  options.time = shutter_seconds / 2;
  options.shutter = Shutter{-shutter_seconds / 2, shutter_seconds / 2};
  settings.limits.spp = 2 * instants / thinning;
  const SceneDescription moving = file.describe(options);
  render(moving, settings, 1000, 1, blurred);
  settings.limits.spp = 2;
  options.shutter.reset();
  for (int i = 0; i < instants; ++i) {
    options.time = shutter_seconds * (i + 0.5) / instants;
    render(file.describe(options), settings, uint64_t(i), 1.0 / instants, mean);
  }
  const double significance = sidak(1e-4, 16 * mean.size());
  double contrast = 0;
  for (size_t i = 0; i < mean.size(); ++i) {
    const Samples a = blurred.at(i), b = mean.at(i);
    EXPECT_GT(welch_p_value(a, b), significance)
        << "pixel " << i % width << ' ' << i / width << ": " << a.mean() << " +- " << a.standard_error()
        << ", " << b.mean() << " +- " << b.standard_error();
    contrast = std::max(contrast, std::abs(a.mean()));
  }
  EXPECT_GT(contrast, 0);
}

TEST(MotionBlur, OfAnInstanceThatTurnsGrowsAndIsMirrored) {
  Stage stage;
  const int box = add_box(stage.file, {1, 0.4f, 0.3f}, {{"material", add_material(stage.file, 0.8)}});
  const int node = stage.add_node(box);
  animate(stage.file, node, "rotation", quarter_turn_about_z(), "VEC4");
  animate(stage.file, node, "scale", {-1, 1, 1, -1.4f, 0.7f, 1}, "VEC3");
  animate(stage.file, node, "translation", {-0.5f, 0, 0, 0.5f, 0.3f, 0}, "VEC3");
  expect_mean_of_instants(stage.file);
}

TEST(MotionBlur, OfTwoInstancesOfOneMeshOfWhichOneMoves) {
  Stage stage;
  const int box = add_box(stage.file, {0.4f, 0.4f, 0.3f}, {{"material", add_material(stage.file, 0.8)}});
  stage.add_node(box, {{"translation", {-1, 0, 0}}});
  const int node = stage.add_node(box);
  animate(stage.file, node, "translation", {0, 0, 0, 1, 0.5f, 0}, "VEC3");
  expect_mean_of_instants(stage.file);
}

TEST(MotionBlur, OfAMorph) {
  Stage stage;
  const int mesh = add_box(stage.file, {0.5f, 0.5f, 0.5f}, {{"material", add_material(stage.file, 0.8)}});
  std::vector<float> offsets;
  for (int i = 0; i < 8; ++i) offsets.insert(offsets.end(), {i & 2 ? 0.8f : 0, i & 2 ? 0.5f : 0, 0});
  stage.file.json["meshes"][size_t(mesh)]["primitives"][0]["targets"] = {
      {{"POSITION", stage.file.add_accessor(offsets, "VEC3")}}};
  const int node = stage.add_node(mesh);
  animate(stage.file, node, "weights", {0, 1, 0.2f}, "SCALAR");
  expect_mean_of_instants(stage.file);
}

TEST(MotionBlur, OfASkin) {
  Stage stage;
  const int mesh = add_box(stage.file, {0.4f, 0.8f, 0.4f}, {{"material", add_material(stage.file, 0.8)}});
  auto& attributes = stage.file.json["meshes"][size_t(mesh)]["primitives"][0]["attributes"];
  std::vector<uint8_t> joints;
  std::vector<float> weights;
  for (int i = 0; i < 8; ++i) {
    joints.insert(joints.end(), {0, 1, 0, 0});
    weights.insert(weights.end(), {i & 2 ? 0.2f : 1, i & 2 ? 0.8f : 0, 0, 0});
  }
  attributes["JOINTS_0"] = stage.file.add_accessor(joints, "VEC4");
  attributes["WEIGHTS_0"] = stage.file.add_accessor(weights, "VEC4");
  const int base = stage.file.add_root({{"name", "base"}}), tip = stage.file.add_root({{"name", "tip"}});
  stage.file.add("skins", {{"joints", {base, tip}}});
  stage.add_node(mesh, {{"skin", 0}});
  animate(stage.file, tip, "rotation", quarter_turn_about_z(), "VEC4");
  animate(stage.file, tip, "translation", {0, 0, 0, 0.5f, 0, 0}, "VEC3");
  expect_mean_of_instants(stage.file);
}

TEST(MotionBlur, OfAMovingCamera) {
  Stage stage;
  stage.add_node(add_box(stage.file, {0.5f, 0.5f, 0.5f}, {{"material", add_material(stage.file, 0.8)}}));
  animate(stage.file, stage.camera, "translation", {0, 0, 5, 1.5f, 0.5f, 4.5f}, "VEC3");
  animate(stage.file, stage.camera, "rotation", {0, 0, 0, 1, 0, 0.17364818f, 0, 0.98480775f}, "VEC4");
  RenderSettings with_lens = small_picture(0);
  expect_mean_of_instants(stage.file, with_lens);
}

TEST(MotionBlur, OfAMovingLamp) {
  Stage stage;
  stage.add_node(add_box(stage.file, {0.5f, 0.5f, 0.5f}, {{"material", add_material(stage.file, 0.8)}}));
  animate(stage.file, stage.lamp, "translation", {-3, 2, 2, 3, 2, 2}, "VEC3");
  stage.file.json["extensions"]["KHR_lights_punctual"]["lights"].push_back(
      {{"type", "spot"}, {"intensity", 200}, {"spot", {{"outerConeAngle", 0.5}, {"innerConeAngle", 0.1}}}});
  const int spot = stage.file.add_root(
      {{"translation", {0, 0.5, 4}}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  animate(stage.file, spot, "rotation", {0, -0.2f, 0, 0.98f, 0, 0.2f, 0, 0.98f}, "VEC4");
  expect_mean_of_instants(stage.file);
}

class MovingEmitter : public testing::TestWithParam<LightSampling> {};

TEST_P(MovingEmitter, LightsAsTheMeanOfInstantsByEachTechnique) {
  Stage stage;
  stage.file.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 1;
  stage.add_node(add_box(stage.file, {0.3f, 0.3f, 0.3f}, {{"material", add_material(stage.file, 0.8)}}),
                 {{"translation", {0.8, -0.7, 0}}});
  // Two that glow, of which one moves and turns: the choice between them changes.
  const int glowing = add_material(stage.file, 0, 1);
  stage.add_node(add_box(stage.file, {0.6f, 0.1f, 0.6f}, {{"material", glowing}}),
                 {{"translation", {2, 1.5, 0}}});
  const int node = stage.add_node(add_box(stage.file, {0.5f, 0.05f, 0.5f}, {{"material", glowing}}));
  animate(stage.file, node, "translation", {-1.5f, 0, 0.5f, 0.5f, 0.5f, 0.5f}, "VEC3");
  animate(stage.file, node, "rotation", quarter_turn_about_z(), "VEC4");
  RenderSettings settings = small_picture(0);
  settings.integrator_options.light_sampling = GetParam();
  expect_mean_of_instants(stage.file, settings);
}

INSTANTIATE_TEST_SUITE_P(Techniques, MovingEmitter,
                         testing::Values(LightSampling::mis, LightSampling::light, LightSampling::bsdf));

TEST(MotionBlur, OfAVolumeThatMoves) {
  Stage stage;
  const int glass = stage.file.add(
      "materials",
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.2}}},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {0.5, 0.5, 0.5}}}}}}});
  stage.file.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_transmission",
                                       "KHR_materials_volume"};
  stage.add_node(add_box(stage.file, {0.5f, 0.5f, 0.5f}, {{"material", add_material(stage.file, 0.3, 0.8)}}),
                 {{"translation", {0, 0, -2}}});
  const int node = stage.add_node(add_box(stage.file, {0.6f, 0.6f, 0.2f}, {{"material", glass}}));
  animate(stage.file, node, "translation", {-1, 0, 0, 1, 0.2f, 0}, "VEC3");
  animate(stage.file, node, "rotation", quarter_turn_about_z(), "VEC4");
  RenderSettings settings = small_picture(0);
  settings.integrator_options.max_depth = 6;
  expect_mean_of_instants(stage.file, settings);
}

TEST(MotionBlur, ByRowsShowsEachAtItsOwnTime) {
  // A wall that glows comes from below: without exposure a row shows it where it is at the row's time.
  Stage stage;
  const int wall = add_box(stage.file, {10, 0.05f, 0.05f}, {{"material", add_material(stage.file, 0, 1)}});
  const int node = stage.add_node(wall);
  animate(stage.file, node, "translation", {0, 3, 0, 0, -3, 0}, "VEC3");
  const std::string bytes = stage.file.glb();
  SceneFile file("scene.glb", std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()));
  ImportOptions options;
  options.time = shutter_seconds / 2;
  options.shutter = Shutter{-shutter_seconds / 2, shutter_seconds / 2};
  const SceneDescription moving = file.describe(options);
  RenderSettings settings = small_picture(16);
  settings.camera = moving.cameras.at(0);
  settings.row_exposure = 0;
  RenderSession rolling(build_scene(moving), settings);
  rolling.run();
  const Image picture = *rolling.picture().single("R");
  options.shutter.reset();
  for (int row = 0; row < height; ++row) {
    options.time = shutter_seconds * (row + 0.5) / height;
    settings.row_exposure = 1;
    RenderSession still(build_scene(file.describe(options)), settings);
    still.run();
    const Image instant = *still.picture().single("R");
    for (int x = 0; x < width; ++x)
      EXPECT_NEAR(*picture.pixel(x, row), *instant.pixel(x, row), 0.25) << x << ' ' << row;
  }
}

}  // namespace
}  // namespace vernier::test
