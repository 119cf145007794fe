// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cfloat>
#include <cmath>

#include "tests/scene/import_support.h"

// Values that exporters write and the specification does not allow, or that only a double holds.

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

/// A triangle of glass, and one camera and light of each kind.
GltfFile scene_of_all() {
  GltfFile file;
  file.add_triangle({{"material", 0}});
  file.add("materials", {{"extensions",
                          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                           {"KHR_materials_volume", {{"thicknessFactor", 0}}}}}});
  file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
  file.add_root({{"camera", 0}});
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}},
                                                              {{"type", "spot"}, {"spot", json::object()}}};
  file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  file.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_volume"};
  return file;
}

const std::string volume = "/materials/0/extensions/KHR_materials_volume";
const std::string light = "/extensions/KHR_lights_punctual/lights/0";

SceneDescription with(const std::string& pointer, const json& value) {
  GltfFile file = scene_of_all();
  file.json[json::json_pointer(pointer)] = value;
  return file.import();
}

/// The same with a value that only text can say, such as 1e400.
SceneDescription with_text(const std::string& pointer, const std::string& value) {
  GltfFile file = scene_of_all();
  file.json[json::json_pointer(pointer)] = "VALUE";
  const TemporaryFolder folder;
  std::string text = read_file(file.save(folder));
  text.replace(text.find("\"VALUE\""), 7, value);
  return import_scene(folder.write("scene.gltf", text));
}

TEST(ImportLenient, NullCountsAsAbsent) {
  for (const std::string& pointer :
       {volume + "/attenuationDistance", volume + "/thicknessFactor", volume + "/attenuationColor",
        light + "/range", light + "/color", light + "/name", std::string("/cameras/0/perspective/zfar"),
        std::string("/cameras/0/perspective/aspectRatio"), std::string("/materials/0/alphaMode"),
        std::string("/materials/0/pbrMetallicRoughness"), std::string("/nodes/0/children"),
        std::string("/nodes/0/translation"), std::string("/scene"), std::string("/images"),
        std::string("/meshes/0/primitives/0/attributes/NORMAL"), std::string("/asset/minVersion")}) {
    const SceneDescription scene = with(pointer, nullptr), plain = scene_of_all().import();
    ASSERT_EQ(scene.notices.size(), plain.notices.size() + 1) << pointer;
    EXPECT_EQ(scene.notices[0].place, pointer);
    EXPECT_EQ(scene.notices[0].severity, Notice::Severity::warning);
    EXPECT_THAT(scene.notices[0].text, HasSubstr("null is no value, so the property counts as absent"));
    EXPECT_EQ(scene.instances.size(), 1u);
  }
}

TEST(ImportLenient, ArraysOfNumbersWithNullCountAsAbsent) {
  EXPECT_EQ(with("/nodes/0/translation", {1, nullptr, 3}).instances.at(0).to_world.origin, Vec3f(0, 0, 0));
  EXPECT_EQ(with(volume + "/attenuationColor", {nullptr, nullptr, nullptr}).materials.at(0).attenuation_color,
            Rgb(1, 1, 1));
}

TEST(ImportLenient, RequiredValuesMustNotBeNull) {
  GltfFile file = scene_of_all();
  file.json["accessors"][0]["count"] = nullptr;
  EXPECT_THAT(import_error(file), HasSubstr("/accessors/0/count: expected an integer"));
  file = scene_of_all();
  file.json["nodes"][0]["children"] = {nullptr};
  EXPECT_THAT(import_error(file), HasSubstr("/nodes/0/children/0: expected an integer"));
}

TEST(ImportLenient, ManyNullsAreOneWarning) {
  GltfFile file = scene_of_all();
  for (int i = 0; i < 50; ++i) file.add("materials", {{"alphaCutoff", nullptr}});
  size_t warnings = 0;
  for (const auto& notice : file.import().notices)
    warnings += notice.text.find("alphaCutoff") != std::string::npos;
  EXPECT_EQ(warnings, 1u);
  EXPECT_TRUE(has_notice(file.import(), "49 more places"));
}

TEST(ImportLenient, StrictRefusesWhatWasPutRight) {
  GltfFile file = scene_of_all();
  file.json["nodes"][0]["translation"] = nullptr;
  ImportOptions strict;
  strict.strict = true;
  EXPECT_THAT(import_error(file, strict), HasSubstr("/nodes/0/translation: strict: null"));
}

TEST(ImportLenient, NoAttenuationDistanceMeansNoAbsorption) {
  for (const json& value : {json(0), json(-1), json(nullptr), json(0.0)}) {
    const SceneDescription scene = with(volume + "/attenuationDistance", value);
    EXPECT_TRUE(std::isinf(scene.materials.at(0).attenuation_distance)) << value;
    EXPECT_TRUE(has_notice(scene, value.is_null() ? "absent" : "attenuationDistance of 0 or less")) << value;
  }
  EXPECT_FALSE(has_notice(with(volume + "/attenuationDistance", 1e-35), "attenuationDistance"));
}

TEST(ImportLenient, OptionalNumbersOutOfRangeCountAsAbsent) {
  EXPECT_TRUE(std::isinf(with(light + "/range", -3).lights.at(0).range));
  EXPECT_TRUE(has_notice(with(light + "/range", -3), "-3 is not a number of at least 0"));
  EXPECT_EQ(with("/cameras/0/perspective/aspectRatio", 0).cameras.at(0).aspect, 0.f);
  EXPECT_EQ(with(volume + "/thicknessFactor", -1).materials.at(0).thickness, 0.f);
  EXPECT_EQ(with(light + "/intensity", -2).lights.at(0).intensity, 0.f);
  EXPECT_TRUE(has_notice(with(light + "/intensity", -2), "clamped to 0"));
  EXPECT_EQ(with(light + "/color", {1, -2, 0.5}).lights.at(0).color, Rgb(1, 0, 0.5f));
}

TEST(ImportLenient, ValuesThatAreNoneOfThoseThereAreCountAsAbsent) {
  const SceneDescription scene = with("/materials/0/alphaMode", "BLENDED");
  EXPECT_EQ(scene.materials.at(0).alpha_mode, AlphaMode::opaque);
  EXPECT_TRUE(
      has_notice(scene, "\"BLENDED\" is none of OPAQUE, MASK, BLEND, so the property counts as absent"));
  EXPECT_TRUE(has_notice(with("/samplers", {{{"wrapS", 7}}}), "7 is none of 10497, 33071, 33648"));
}

TEST(ImportLenient, AFieldOfViewBeyondAPlaneIsNarrowed) {
  const SceneDescription scene = with("/cameras/0/perspective/yfov", 40);
  EXPECT_LT(scene.cameras.at(0).yfov, 3.1415f);
  EXPECT_TRUE(has_notice(scene, "40 radians are more than a plane picture can show"));
}

TEST(ImportLenient, ABufferWithoutDataMayBeThereIfNothingUsesIt) {
  GltfFile file;
  file.add_triangle();
  const TemporaryFolder folder;
  file.save(folder);
  file.json["buffers"] = {{{"uri", "data.bin"}, {"byteLength", file.buffer.size()}}, {{"byteLength", 8}}};
  file.add("bufferViews", {{"buffer", 1}, {"byteLength", 8}});
  EXPECT_THAT(import_error(folder.write("unused.gltf", file.json.dump())), IsEmpty());
  file.json["accessors"][0]["bufferView"] = 1;
  EXPECT_THAT(import_error(folder.write("used.gltf", file.json.dump())),
              HasSubstr("/buffers/1: the buffer has no uri and the file has no binary chunk for it"));
}

TEST(ImportLenient, NumbersBeyondSinglePrecisionBecomeItsLargest) {
  for (const char* text : {"3.4028235e38", "3.40282347e+38", "3.4028234663852886e38", "1e39", "1.8e308",
                           "1e400", "1E+999", "123456e9999"}) {
    EXPECT_EQ(with_text(light + "/range", text).lights.at(0).range, FLT_MAX) << text;
    EXPECT_EQ(with_text(volume + "/attenuationDistance", text).materials.at(0).attenuation_distance, FLT_MAX);
    EXPECT_EQ(with_text("/cameras/0/perspective/zfar", text).cameras.size(), 1u);
    EXPECT_EQ(
        with_text("/materials/0/alphaCutoff", std::string("-").append(text)).materials.at(0).alpha_cutoff,
        -FLT_MAX);
    EXPECT_TRUE(with_text(light + "/range", text).notices.size() == scene_of_all().import().notices.size());
  }
  const std::string digits(400, '9');
  EXPECT_EQ(with_text(light + "/range", digits).lights.at(0).range, FLT_MAX);
  EXPECT_EQ(with_text(light + "/range", digits + ".5").lights.at(0).range, FLT_MAX);
}

TEST(ImportLenient, NumbersThatUnderflowAreZero) {
  EXPECT_EQ(with_text("/materials/0/alphaCutoff", "1e-400").materials.at(0).alpha_cutoff, 0.f);
  EXPECT_EQ(with_text("/extras", "[1e400, 1e-400, \"1e400 in a \\\" string\", -1e400]").instances.size(), 1u);
}

TEST(ImportLenient, OverflowingIndicesAreNamed) {
  EXPECT_THROW(with_text("/nodes/0/mesh", "1e400"), Error);
  EXPECT_THROW(with_text("/accessors/0/count", "1e400"), Error);
}

TEST(ImportLenient, BoundsOfAccessorsAreNotRead) {
  for (const json& bounds : {json({3.4028235e38, -3.4028235e38, 1.7e308}), json({nullptr, nullptr, nullptr}),
                             json::array(), json("none"), json(nullptr)}) {
    GltfFile file = scene_of_all();
    file.json["accessors"][0]["min"] = bounds;
    file.json["accessors"][0]["max"] = bounds;
    EXPECT_THAT(import_error(file), IsEmpty()) << bounds;
  }
}

}  // namespace
}  // namespace vernier::test
