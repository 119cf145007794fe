// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "tests/scene/import_support.h"
#include "tests/support/png_bytes.h"
#include "vernier/scene_file.h"

// KHR_animation_pointer: what animations set by JSON pointers.

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Two triangles of two materials, a camera of each kind and a light of each kind.
class Set {
 public:
  Set() {
    file.json["extensionsUsed"] = {"KHR_animation_pointer"};
    file.add("images",
             {{"bufferView", file.add_view(png_bytes({.samples = {9, 9, 9}}))}, {"mimeType", "image/png"}});
    file.add("textures", {{"source", 0}});
    for (const char* name : {"a", "b"})
      file.add_triangle({{"material", file.add("materials", {{"name", name}})}});
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    file.add("cameras", {{"type", "orthographic"},
                         {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}});
    for (int i = 0; i < 2; ++i) file.add_root({{"camera", i}});
    auto& lights = file.json["extensions"]["KHR_lights_punctual"]["lights"];
    lights = {{{"type", "point"}}, {{"type", "spot"}}};
    for (int i = 0; i < 2; ++i) file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  }

  json& material(int i) { return file.json["materials"][size_t(i)]; }

  /// Lets an animation of its own go from `from` to `to` between 0 and 1 s.
  void animate(const std::string& pointer, std::vector<float> from, const std::vector<float>& to,
               const std::string& interpolation = "LINEAR") {
    const std::string type = from.size() == 1 ? "SCALAR" : "VEC" + std::to_string(from.size());
    from.insert(from.end(), to.begin(), to.end());
    animate_with(pointer, file.add_accessor(from, type), interpolation);
  }
  void animate_with(const std::string& pointer, int output, const std::string& interpolation = "LINEAR") {
    const int input = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
    const json target = {{"path", "pointer"},
                         {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
    file.add("animations",
             {{"channels", {{{"sampler", 0}, {"target", target}}}},
              {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}});
  }

  SceneDescription at(double time) const {
    ImportOptions options;
    options.time = time;
    return file.import(options);
  }

  GltfFile file;
};

TEST(AnimationPointer, SetsFactorsOfMaterials) {
  Set set;
  set.animate("/materials/1/pbrMetallicRoughness/baseColorFactor", {0, 0, 0, 0}, {1, 0.5, 0.25, 1});
  set.animate("/materials/1/pbrMetallicRoughness/roughnessFactor", {0}, {1});
  set.animate("/materials/0/emissiveFactor", {0, 0, 0}, {1, 1, 0.5});
  set.animate("/materials/0/alphaCutoff", {0}, {1});
  const SceneDescription scene = set.at(0.5);
  EXPECT_EQ(scene.materials.at(1).base_color, Vec4f(0.5f, 0.25f, 0.125f, 0.5f));
  EXPECT_EQ(scene.materials[1].roughness, 0.5f);
  EXPECT_EQ(scene.materials[0].base_color, Vec4f(1, 1, 1, 1));
  EXPECT_EQ(scene.materials[0].emissive, Rgb(0.5f, 0.5f, 0.25f));
  EXPECT_EQ(scene.materials[0].alpha_cutoff, 0.5f);
  EXPECT_EQ(set.file.import().materials[1].base_color, Vec4f(1, 1, 1, 1)) << "at rest without a time";
}

TEST(AnimationPointer, SetsWhatExtensionsOfMaterialsHave) {
  struct Case {
    const char* extension;
    const char* property;
    float MaterialDescription::*field;
  };
  const Case cases[] = {
      {"anisotropy", "anisotropyStrength", &MaterialDescription::anisotropy},
      {"anisotropy", "anisotropyRotation", &MaterialDescription::anisotropy_rotation},
      {"clearcoat", "clearcoatFactor", &MaterialDescription::clearcoat},
      {"clearcoat", "clearcoatRoughnessFactor", &MaterialDescription::clearcoat_roughness},
      {"diffuse_roughness", "diffuseRoughnessFactor", &MaterialDescription::diffuse_roughness},
      {"diffuse_transmission", "diffuseTransmissionFactor", &MaterialDescription::diffuse_transmission},
      {"dispersion", "dispersion", &MaterialDescription::dispersion},
      {"iridescence", "iridescenceFactor", &MaterialDescription::iridescence},
      {"iridescence", "iridescenceThicknessMinimum", &MaterialDescription::iridescence_thickness_min},
      {"iridescence", "iridescenceThicknessMaximum", &MaterialDescription::iridescence_thickness_max},
      {"sheen", "sheenRoughnessFactor", &MaterialDescription::sheen_roughness},
      {"specular", "specularFactor", &MaterialDescription::specular},
      {"transmission", "transmissionFactor", &MaterialDescription::transmission},
      {"volume", "thicknessFactor", &MaterialDescription::thickness},
      {"volume", "attenuationDistance", &MaterialDescription::attenuation_distance},
  };
  for (const auto& [extension, property, field] : cases) {
    Set set;
    const std::string name = std::string("KHR_materials_") + extension;
    set.material(1)["extensions"][name] = json::object();
    set.animate("/materials/1/extensions/" + name + "/" + property, {0.25f}, {0.75f});
    EXPECT_EQ(set.at(0.5).materials.at(1).*field, 0.5f) << property;
  }
}

TEST(AnimationPointer, SetsColorsOfExtensions) {
  struct Case {
    const char* pointer;
    Rgb MaterialDescription::*field;
  };
  const Case cases[] = {
      {"KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor",
       &MaterialDescription::diffuse_transmission_color},
      {"KHR_materials_sheen/sheenColorFactor", &MaterialDescription::sheen_color},
      {"KHR_materials_specular/specularColorFactor", &MaterialDescription::specular_color},
      {"KHR_materials_volume/attenuationColor", &MaterialDescription::attenuation_color},
  };
  for (const auto& [pointer, field] : cases) {
    Set set;
    set.animate(std::string("/materials/1/extensions/") + pointer, {0, 0, 0}, {1, 0.5, 0.25});
    EXPECT_EQ(set.at(0.5).materials.at(1).*field, Rgb(0.5f, 0.25f, 0.125f)) << pointer;
  }
  Set set;
  set.material(0)["emissiveFactor"] = {1, 1, 1};
  set.animate("/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", {0}, {8});
  set.animate("/materials/0/extensions/KHR_materials_ior/ior", {1}, {2});
  set.animate("/materials/0/extensions/KHR_materials_iridescence/iridescenceIor", {1}, {2});
  const SceneDescription scene = set.at(0.5);
  EXPECT_EQ(scene.materials.at(0).emissive, Rgb(4, 4, 4));
  EXPECT_EQ(scene.materials[0].ior, 1.5f);
  EXPECT_EQ(scene.materials[0].iridescence_ior, 1.5f);
}

TEST(AnimationPointer, SetsTextureTransformsAndScalesOfNormals) {
  Set set;
  set.material(0)["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  set.material(0)["normalTexture"]["index"] = 0;
  set.material(0)["extensions"]["KHR_materials_clearcoat"]["clearcoatNormalTexture"]["index"] = 0;
  const std::string transform = "/extensions/KHR_texture_transform/";
  set.animate("/materials/0/pbrMetallicRoughness/baseColorTexture" + transform + "offset", {0, 0}, {1, 2});
  set.animate("/materials/0/pbrMetallicRoughness/baseColorTexture" + transform + "scale", {1, 1}, {3, 5});
  set.animate("/materials/0/normalTexture" + transform + "rotation", {0}, {1});
  set.animate("/materials/0/normalTexture/scale", {0}, {1});
  const std::string coat = "/materials/0/extensions/KHR_materials_clearcoat/clearcoatNormalTexture";
  set.animate(coat + transform + "rotation", {0}, {3});
  set.animate(coat + "/scale", {0}, {3});
  const SceneDescription scene = set.at(0.5);
  const MaterialDescription& m = scene.materials.at(0);
  EXPECT_EQ(m.base_color_texture.offset, Vec2f(0.5f, 1));
  EXPECT_EQ(m.base_color_texture.scale, Vec2f(2, 3));
  EXPECT_EQ(m.normal_texture.rotation, 0.5f);
  EXPECT_EQ(m.normal_scale, 0.5f);
  EXPECT_EQ(m.clearcoat_normal_texture.rotation, 1.5f);
  EXPECT_EQ(m.clearcoat_normal_scale, 1.5f);
}

TEST(AnimationPointer, SetsCamerasAndLights) {
  Set set;
  set.animate("/cameras/0/perspective/yfov", {0.5}, {1.5});
  set.animate("/cameras/0/perspective/aspectRatio", {1}, {3});
  set.animate("/cameras/1/orthographic/xmag", {1}, {3});
  set.animate("/cameras/1/orthographic/ymag", {2}, {6});
  const std::string lights = "/extensions/KHR_lights_punctual/lights/";
  set.animate(lights + "0/color", {0, 0, 0}, {1, 0.5, 0});
  set.animate(lights + "0/intensity", {0}, {10});
  set.animate(lights + "0/range", {2}, {4});
  set.animate(lights + "1/spot/innerConeAngle", {0}, {0.5});
  set.animate(lights + "1/spot/outerConeAngle", {0.5}, {1});
  const SceneDescription scene = set.at(0.5);
  EXPECT_EQ(scene.cameras.at(0).yfov, 1.f);
  EXPECT_EQ(scene.cameras[0].aspect, 2.f);
  EXPECT_EQ(scene.cameras.at(1).xmag, 2.f);
  EXPECT_EQ(scene.cameras[1].ymag, 4.f);
  EXPECT_EQ(scene.lights.at(0).color, Rgb(0.5f, 0.25f, 0));
  EXPECT_EQ(scene.lights[0].intensity, 5.f);
  EXPECT_EQ(scene.lights[0].range, 3.f);
  EXPECT_EQ(scene.lights.at(1).inner_cone, 0.25f);
  EXPECT_EQ(scene.lights[1].outer_cone, 0.75f);
}

TEST(AnimationPointer, MovesNodesAndTurnsThemOnTheSphere) {
  Set set;
  const float s = std::sqrt(0.5f);
  set.animate("/nodes/0/translation", {0, 0, 0}, {2, 4, 6});
  set.animate("/nodes/0/scale", {1, 1, 1}, {3, 3, 3});
  set.animate("/nodes/1/rotation", {0, 0, 0, 1}, {0, 0, s, s});
  const SceneDescription scene = set.at(0.5);
  EXPECT_EQ(scene.instances.at(0).to_world.origin, Vec3f(1, 2, 3));
  EXPECT_EQ(scene.instances[0].to_world.x, Vec3f(2, 0, 0));
  EXPECT_NEAR(scene.instances.at(1).to_world.x.x, std::cos(0.25 * std::acos(-1.0)), 1e-6) << "an eighth turn";
}

TEST(AnimationPointer, ShowsAndHidesNodes) {
  Set set;
  set.file.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  set.animate_with("/nodes/0/extensions/KHR_node_visibility/visible",
                   set.file.add_accessor(std::vector<uint8_t>{0, 1}, "SCALAR"), "STEP");
  set.animate_with("/nodes/1/extensions/KHR_node_visibility/visible",
                   set.file.add_accessor(std::vector<uint8_t>{1, 0}, "SCALAR"), "STEP");
  EXPECT_EQ(set.at(0.9).instances.size(), 1u);
  EXPECT_EQ(set.at(0.9).materials.at(0).name, "b");
  EXPECT_EQ(set.at(1).materials.at(0).name, "a");
}

TEST(AnimationPointer, SetsMorphWeightsOfMeshesAndNodes) {
  Set set;
  const int up = set.file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int right = set.file.add_accessor(std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
  const json targets = {{{"POSITION", up}}, {{"POSITION", right}}};
  set.file.json["meshes"][0]["primitives"][0]["targets"] = targets;
  set.file.json["meshes"][0]["weights"] = {3, 5};
  set.file.add_root({{"mesh", 0}, {"weights", {7, 9}}});
  set.animate("/meshes/0/weights/1", {0}, {1});
  SceneDescription scene = set.at(0.5);
  EXPECT_EQ(scene.meshes.at(0).positions[0], Vec3f(0.5f, 0, 3)) << "the mesh's other weight stays";
  EXPECT_EQ(scene.meshes.at(2).positions[0], Vec3f(9, 0, 7)) << "a node's own weights hold";
  set.animate_with("/nodes/0/weights", set.file.add_accessor(std::vector<float>{0, 0, 2, 4}, "SCALAR"));
  EXPECT_EQ(set.at(0.5).meshes.at(0).positions[0], Vec3f(2, 0, 1));
}

TEST(AnimationPointer, ThatNamesNothingIsSaidOnce) {
  for (const char* pointer :
       {"/materials/2/emissiveFactor", "/materials/00/emissiveFactor", "/materials/0/emissiveFactor/0",
        "/materials/0/normalTexture/scale", "/materials/0/doubleSided", "/nodes/99/translation",
        "/nodes/0/weights/0", "/cameras/0/orthographic/xmag", "materials/0/emissiveFactor",
        "/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", "/materials/-1/alphaCutoff",
        "/materials/0/normalTexture/extensions/KHR_texture_transform/offset", "", "/~/"}) {
    Set set;
    set.animate(pointer, {1}, {0});
    set.animate("/nodes/0/scale", {1, 1, 1}, {3, 3, 3});
    const SceneDescription scene = set.at(0.5);
    EXPECT_EQ(scene.instances.at(0).to_world.x, Vec3f(2, 0, 0)) << "the rest of the animation holds";
    ASSERT_EQ(scene.features.at(0).name, "KHR_animation_pointer");
    EXPECT_EQ(scene.features[0].status, FeatureUse::Status::approximated);
    EXPECT_TRUE(has_notice(scene, "KHR_animation_pointer is approximated: '" + std::string(pointer) +
                                      "' names nothing that the file has"))
        << pointer;
  }
}

TEST(AnimationPointer, ValuesOutsideTheirRangeAreClampedWithAWarning) {
  Set set;
  set.animate("/cameras/0/perspective/yfov", {-1}, {-2});
  set.animate("/extensions/KHR_lights_punctual/lights/0/intensity", {-1}, {-1});
  const SceneDescription scene = set.at(0.5);
  EXPECT_GT(scene.cameras.at(0).yfov, 0);
  EXPECT_TRUE(has_notice(scene, "the animated value is outside its range and was clamped"));
  EXPECT_EQ(scene.lights.at(0).intensity, 0.f);
}

TEST(AnimationPointer, ValuesMustHaveTheWidthOfTheProperty) {
  Set set;
  set.animate("/materials/0/emissiveFactor", {1}, {0});
  ImportOptions options;
  options.time = 0;
  EXPECT_THAT(import_error(set.file, options), HasSubstr("expected 3 values a key, found 1"));
}

TEST(AnimationPointer, FramesOfOneFileAreThoseOfItReadAnew) {
  Set set;
  set.file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "swapped"}}};
  set.file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
      {{"material", 1}, {"variants", {0}}}};
  set.animate("/materials/1/emissiveFactor", {0, 0, 0}, {1, 1, 1});
  const TemporaryFolder folder;
  SceneFile file(set.file.save(folder));
  ImportOptions options;
  options.variant = "swapped";
  options.time = 1;
  EXPECT_EQ(file.describe(options).materials.at(0).emissive, Rgb(1, 1, 1));
  options.time = 0.25;
  EXPECT_EQ(file.describe(options).materials.at(0).emissive, Rgb(0.25f, 0.25f, 0.25f));
  options.time.reset();
  EXPECT_EQ(file.describe(options).materials.at(0).emissive, Rgb(0, 0, 0)) << "at rest again";
  EXPECT_EQ(file.animations().at(0).seconds, 1);
}

TEST(AnimationPointer, ThatSetsWhatAnotherChannelSetsIsTheSameProperty) {
  Set set;
  set.animate("/nodes/0/translation", {0, 0, 0}, {2, 0, 0});
  set.animate("/nodes/0/translation", {0, 0, 0}, {4, 0, 0});
  set.file.json["animations"][1]["channels"][0]["target"] = {{"node", 0}, {"path", "translation"}};
  const SceneDescription scene = set.at(1);
  EXPECT_TRUE(has_notice(scene, "of 2 animations only the first, '0', poses the scene"));
  EXPECT_EQ(scene.instances.at(0).to_world.origin.x, 2.f);
}

}  // namespace
}  // namespace vernier::test
