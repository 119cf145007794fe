// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "core/image/image_io.h"
#include "tests/scene/import_support.h"
#include "tests/support/png_bytes.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string png(const std::vector<uint8_t>& rgb) {
  PngSource source;
  source.width = uint32_t(rgb.size() / 3);
  source.samples = rgb;
  const auto bytes = png_bytes(source);
  return {bytes.begin(), bytes.end()};
}

/// A triangle with texture coordinates and the material given.
GltfFile with_material(const json& material) {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int texcoords = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  file.add("materials", material);
  file.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", texcoords}, {"TEXCOORD_1", texcoords}},
                {{"material", 0}});
  return file;
}

json base_color_texture(int index) {
  return {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", index}}}}}};
}

TEST(ImportMaterials, GivesPrimitivesWithoutOneTheDefault) {
  GltfFile file;
  file.add_triangle();
  file.add("materials", {{"name", "unused"}});
  const SceneDescription scene = file.import();
  ASSERT_EQ(scene.materials.size(), 1u) << "materials that nothing uses are left out";
  const MaterialDescription& m = scene.materials[0];
  EXPECT_EQ(m.base_color, Vec4f(1, 1, 1, 1));
  EXPECT_EQ(m.metallic, 1.f);
  EXPECT_EQ(m.roughness, 1.f);
  EXPECT_EQ(m.emissive, Rgb(0, 0, 0));
  EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.specular, 1.f);
  EXPECT_EQ(m.transmission, 0.f);
  EXPECT_TRUE(std::isinf(m.attenuation_distance));
  EXPECT_EQ(m.clearcoat, 0.f);
}

/// A closed body of wax with the scattering extension given.
json wax(const std::string& extension, const json& scattering) {
  return {{"extensions",
           {{"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1}}},
            {"KHR_materials_volume",
             {{"thicknessFactor", 1}, {"attenuationDistance", 0.1}, {"attenuationColor", {0.5, 0.5, 0.5}}}},
            {extension, scattering}}}};
}

// Kulla and Conty 2017: nothing and everything stay, 0.8 takes scatterings of 0.9906 each.
TEST(ImportMaterials, ReadsScatteringOfBothDrafts) {
  const MaterialDescription first =
      with_material(wax("KHR_materials_volume_scatter",
                        {{"multiscatterColor", {0, 0.8, 1}}, {"scatterAnisotropy", 0.3}}))
          .import()
          .materials[0];
  EXPECT_NEAR(first.scattering_albedo.x, 0, 1e-4f);
  EXPECT_NEAR(first.scattering_albedo.y, 0.9906f, 1e-3f);
  EXPECT_NEAR(first.scattering_albedo.z, 1, 1e-4f);
  EXPECT_EQ(first.scattering_anisotropy, 0.3f);
  const auto later = [](double strength) {
    return with_material(wax("KHR_materials_scatter", {{"scatterStrengthFactor", strength},
                                                       {"multiscatterColorFactor", {0.8, 0.8, 0.8}},
                                                       {"scatterAnisotropy", 0.5}}))
        .import()
        .materials[0]
        .scattering_albedo;
  };
  const float s2 = 1 - first.scattering_albedo.y;
  EXPECT_NEAR(later(1).y, (1 - s2) / (1 - 0.5f * s2), 1e-4f);
  EXPECT_EQ(later(0), Rgb(0, 0, 0));
  EXPECT_LT(later(0.5).y, later(1).y);
}

TEST(ImportMaterials, WarnsOfScatteringThatScattersNothing) {
  const json scattering{{"multiscatterColor", {0.8, 0.8, 0.8}}};
  json thin = wax("KHR_materials_volume_scatter", scattering), clear = thin;
  thin["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 0;
  clear["extensions"]["KHR_materials_volume"].erase("attenuationDistance");
  const auto [of_thin, of_clear] = std::pair(with_material(thin).import(), with_material(clear).import());
  EXPECT_TRUE(has_notice(of_thin, "the material is thin-walled"));
  EXPECT_TRUE(has_notice(of_clear, "nothing is scattered"));
  for (const SceneDescription* scene : {&of_thin, &of_clear})
    EXPECT_EQ(scene->materials[0].scattering_albedo, Rgb(0, 0, 0));
  EXPECT_TRUE(has_notice(with_material(wax("KHR_materials_volume_scatter",
                                           {{"multiscatterColor", {1, 1, 1}}, {"scatterAnisotropy", 1.5}}))
                             .import(),
                         "scatterAnisotropy"));
}

TEST(ImportMaterials, ReadsFactors) {
  const MaterialDescription m =
      with_material(
          {{"name", "paint"},
           {"pbrMetallicRoughness",
            {{"baseColorFactor", {.1, .2, .3, .4}}, {"metallicFactor", .5}, {"roughnessFactor", .6}}},
           {"emissiveFactor", {1, .5, .25}},
           {"alphaMode", "MASK"},
           {"alphaCutoff", .7},
           {"doubleSided", true},
           {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}})
          .import()
          .materials.at(0);
  EXPECT_EQ(m.name, "paint");
  EXPECT_EQ(m.base_color, Vec4f(.1f, .2f, .3f, .4f));
  EXPECT_EQ(m.metallic, .5f);
  EXPECT_EQ(m.roughness, .6f);
  EXPECT_EQ(m.emissive, Rgb(8, 4, 2));
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(m.alpha_cutoff, .7f);
  EXPECT_TRUE(m.double_sided);
  EXPECT_FALSE(m.unlit);
}

TEST(ImportMaterials, ReadsWhatTheCameraDoesNotSee) {
  const auto hidden = [](const json& extras) {
    return with_material({{"extras", extras}}).import().materials.at(0).hidden_from_camera;
  };
  EXPECT_TRUE(hidden({{"vernier", {{"hiddenFromCamera", true}}}}));
  EXPECT_FALSE(hidden({{"vernier", {{"hiddenFromCamera", false}}}}));
  // Extras may be anything.
  for (const json& other : {json(3), json{{"vernier", 3}}, json{{"vernier", {{"hiddenFromCamera", "yes"}}}}})
    EXPECT_FALSE(hidden(other));
}

TEST(ImportMaterials, ReadsExtensions) {
  const json extensions = {
      {"KHR_materials_unlit", json::object()},
      {"KHR_materials_ior", {{"ior", 1.33}}},
      {"KHR_materials_specular", {{"specularFactor", .5}, {"specularColorFactor", {.1, .2, 3}}}},
      {"KHR_materials_transmission", {{"transmissionFactor", .9}}},
      {"KHR_materials_volume",
       {{"thicknessFactor", .01}, {"attenuationDistance", 2}, {"attenuationColor", {.1, .2, .3}}}},
      {"KHR_materials_clearcoat", {{"clearcoatFactor", .3}, {"clearcoatRoughnessFactor", .4}}},
      {"KHR_materials_sheen", {{"sheenColorFactor", {.5, .6, .7}}, {"sheenRoughnessFactor", .8}}},
      {"KHR_materials_anisotropy", {{"anisotropyStrength", .6}, {"anisotropyRotation", 1.5}}},
      {"KHR_materials_iridescence",
       {{"iridescenceFactor", .2}, {"iridescenceIor", 1.8}, {"iridescenceThicknessMaximum", 550}}},
      {"KHR_materials_dispersion", {{"dispersion", .36}}},
      {"KHR_materials_diffuse_roughness", {{"diffuseRoughnessFactor", .65}}},
      {"KHR_materials_diffuse_transmission",
       {{"diffuseTransmissionFactor", .25}, {"diffuseTransmissionColorFactor", {1, .5, 0}}}}};
  const MaterialDescription m = with_material({{"extensions", extensions}}).import().materials.at(0);
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_EQ(m.specular, .5f);
  EXPECT_EQ(m.specular_color, Rgb(.1f, .2f, 3));
  EXPECT_EQ(m.transmission, .9f);
  EXPECT_EQ(m.thickness, .01f);
  EXPECT_EQ(m.attenuation_distance, 2.f);
  EXPECT_EQ(m.attenuation_color, Rgb(.1f, .2f, .3f));
  EXPECT_EQ(m.clearcoat, .3f);
  EXPECT_EQ(m.clearcoat_roughness, .4f);
  EXPECT_EQ(m.sheen_color, Rgb(.5f, .6f, .7f));
  EXPECT_EQ(m.sheen_roughness, .8f);
  EXPECT_EQ(m.anisotropy, .6f);
  EXPECT_EQ(m.anisotropy_rotation, 1.5f);
  EXPECT_EQ(m.iridescence, .2f);
  EXPECT_EQ(m.iridescence_ior, 1.8f);
  EXPECT_EQ(m.iridescence_thickness_min, 100.f);
  EXPECT_EQ(m.iridescence_thickness_max, 550.f);
  EXPECT_EQ(m.dispersion, .36f);
  EXPECT_EQ(m.diffuse_roughness, .65f);
  EXPECT_EQ(m.diffuse_transmission, .25f);
  EXPECT_EQ(m.diffuse_transmission_color, Rgb(1, .5f, 0));
}

TEST(ImportMaterials, ClampsWithANotice) {
  const SceneDescription scene =
      with_material({{"pbrMetallicRoughness", {{"roughnessFactor", 1.5}}}, {"emissiveFactor", {-1, 2, 0}}})
          .import();
  EXPECT_EQ(scene.materials.at(0).roughness, 1.f);
  EXPECT_EQ(scene.materials.at(0).emissive, Rgb(0, 2, 0));
  EXPECT_TRUE(has_notice(scene, "roughnessFactor is outside its range"));
  EXPECT_TRUE(has_notice(scene, "emissiveFactor is outside its range"));
}

TEST(ImportMaterials, ReadsTextureUses) {
  const TemporaryFolder folder;
  folder.write("a.png", png({255, 0, 0}));
  folder.write("b c.png", png({0, 255, 0, 1, 2, 3}));
  GltfFile file = with_material(
      {{"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", 2},
           {"extensions",
            {{"KHR_texture_transform",
              {{"offset", {.1, .2}}, {"scale", {3, 4}}, {"rotation", .5}, {"texCoord", 1}}}}}}}}},
       {"normalTexture", {{"index", 0}, {"scale", .5}}},
       {"extensions",
        {{"KHR_materials_specular", {{"specularColorTexture", {{"index", 0}, {"texCoord", 1}}}}}}}});
  file.add("images", {{"uri", "a.png"}});
  file.add("images", {{"uri", "b%20c.png"}});
  file.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
  file.add("textures", {{"source", 0}});
  file.add("textures", {{"source", 0}});  // nothing uses it
  file.add("textures", {{"source", 1}, {"sampler", 0}});
  const SceneDescription scene = import_scene(file.save(folder));
  const MaterialDescription& m = scene.materials.at(0);
  ASSERT_EQ(scene.textures.size(), 2u);
  ASSERT_TRUE(m.base_color_texture && m.normal_texture && m.specular_color_texture);
  EXPECT_FALSE(m.metallic_roughness_texture);
  EXPECT_EQ(m.base_color_texture.texcoord, 1);
  EXPECT_EQ(m.base_color_texture.offset, Vec2f(.1f, .2f));
  EXPECT_EQ(m.base_color_texture.scale, Vec2f(3, 4));
  EXPECT_EQ(m.base_color_texture.rotation, .5f);
  EXPECT_EQ(m.normal_scale, .5f);
  EXPECT_EQ(m.specular_color_texture.texcoord, 1);
  EXPECT_EQ(m.specular_color_texture.texture, m.normal_texture.texture);
  const Texture& base = scene.textures[size_t(m.base_color_texture.texture)];
  EXPECT_EQ(base.image().width, 2);
  EXPECT_EQ(base.wrap_s(), WrapMode::clamp_to_edge);
  EXPECT_EQ(base.wrap_t(), WrapMode::mirrored_repeat);
  EXPECT_EQ(base.filter(), FilterMode::nearest);
  const Texture& normal = scene.textures[size_t(m.normal_texture.texture)];
  EXPECT_EQ(normal.image().values, (std::vector<uint8_t>{255, 0, 0}));
  EXPECT_EQ(normal.wrap_s(), WrapMode::repeat);
  EXPECT_EQ(normal.filter(), FilterMode::linear);
  EXPECT_FALSE(scene.meshes.at(0).texcoords[0].empty());
  EXPECT_FALSE(scene.meshes.at(0).texcoords[1].empty());
}

TEST(ImportMaterials, SharesPixelsBetweenTexturesOfOneImage) {
  const TemporaryFolder folder;
  folder.write("a.png", png({255, 0, 0}));
  GltfFile file = with_material({{"emissiveTexture", {{"index", 0}}}, {"normalTexture", {{"index", 1}}}});
  file.add("images", {{"uri", "a.png"}});
  file.add("samplers", {{"wrapS", 33071}});
  file.add("textures", {{"source", 0}});
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  const SceneDescription scene = import_scene(file.save(folder));
  ASSERT_EQ(scene.textures.size(), 2u);
  EXPECT_EQ(&scene.textures[0].image(), &scene.textures[1].image());
}

TEST(ImportMaterials, ReadsImagesFromBuffersAndHashesFiles) {
  GltfFile file = with_material(base_color_texture(0));
  const std::string bytes = png({9, 8, 7});
  const int view = file.add_view(std::vector<char>(bytes.begin(), bytes.end()));
  file.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  file.add("textures", {{"source", 0}});
  EXPECT_EQ(file.import().textures.at(0).image().values, (std::vector<uint8_t>{9, 8, 7}));

  const TemporaryFolder folder;
  folder.write("a.png", bytes);
  file.json["images"][0] = {{"uri", "a.png"}};
  const std::string path = file.save(folder), hash = import_scene(path).hash;
  folder.write("a.png", png({9, 8, 6}));
  EXPECT_NE(import_scene(path).hash, hash);
}

TEST(ImportMaterials, KeepsSixteenBits) {
  GltfFile file = with_material({{"normalTexture", {{"index", 0}}}});
  const auto bytes =
      png_bytes({.width = 1, .bit_depth = 16, .samples = {0x80, 0x01, 0x7f, 0xfe, 0xff, 0xff}});
  file.add("images", {{"bufferView", file.add_view(bytes)}, {"mimeType", "image/png"}});
  file.add("textures", {{"source", 0}});
  const SceneDescription scene = file.import();
  EXPECT_EQ(scene.textures.at(0).image<uint16_t>().values, (std::vector<uint16_t>{0x8001, 0x7ffe, 0xffff}));
}

TEST(ImportMaterials, RefusesAnImageOfNoPlace) {
  GltfFile file = with_material(base_color_texture(0));
  file.add("images", {{"uri", "../gone.png"}});
  file.add("textures", {{"source", 0}});
  EXPECT_THAT(import_error(file), HasSubstr("leaves the scene file's folder"));
  file.json["images"][0] = {{"uri", "gone.png"}, {"bufferView", 0}};
  EXPECT_THAT(import_error(file), HasSubstr("/images/0: expected either a uri or a bufferView"));
}

TEST(ImportMaterials, ReplacesAnUnreadableImage) {
  const TemporaryFolder folder;
  const std::string ktx2("\xABKTX 20\xBB\r\n\x1A\n and more", 21);
  for (const std::string& content : {ktx2, std::string("this is no picture")}) {
    folder.write("a.ktx2", content);
    GltfFile file = with_material({{"pbrMetallicRoughness",
                                    {{"baseColorTexture", {{"index", 0}}},
                                     {"metallicRoughnessTexture", {{"index", 0}}},
                                     {"roughnessFactor", .3}}},
                                   {"normalTexture", {{"index", 0}}},
                                   {"emissiveTexture", {{"index", 0}}},
                                   {"emissiveFactor", {1, 1, 1}}});
    file.add("images", {{"uri", "a.ktx2"}});
    file.add("textures", {{"source", 0}, {"name", "skin"}});
    const std::string path = file.save(folder);
    const SceneDescription scene = import_scene(path);
    const MaterialDescription& m = scene.materials.at(0);
    EXPECT_TRUE(has_notice(scene, "texture 'skin' cannot be read"));
    ASSERT_TRUE(m.base_color_texture);
    EXPECT_EQ(scene.textures.at(0).image().values, (std::vector<uint8_t>{255, 0, 255}));
    EXPECT_FALSE(m.metallic_roughness_texture);
    EXPECT_EQ(m.roughness, .3f);
    EXPECT_FALSE(m.normal_texture);
    EXPECT_EQ(m.emissive, Rgb(0, 0, 0));
    ImportOptions strict;
    strict.strict = true;
    EXPECT_THAT(import_error(path, strict), HasSubstr("/textures/0: strict: texture 'skin' cannot be read"));
  }
}

TEST(ImportMaterials, ChoosesVariants) {
  GltfFile file = with_material({{"name", "plain"}});
  file.add("materials", {{"name", "red"}});
  file.json["extensionsUsed"] = {"KHR_materials_variants"};
  file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "Midnight"}},
                                                                   {{"name", "Beach"}}};
  file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
      {{"material", 1}, {"variants", {1}}}};
  ImportOptions options;
  EXPECT_EQ(file.import(options).materials.at(0).name, "plain");
  options.variant = "Midnight";
  EXPECT_EQ(file.import(options).materials.at(0).name, "plain") << "not mapped";
  options.variant = "Beach";
  EXPECT_EQ(file.import(options).materials.at(0).name, "red");
  options.variant = "beach";
  EXPECT_THAT(import_error(file, options), HasSubstr("unknown variant 'beach'; did you mean 'Beach'?"));
}

}  // namespace
}  // namespace vernier::test
