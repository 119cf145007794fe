// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/scene/import_support.h"
#include "tests/support/png_bytes.h"

namespace vernier::test {
namespace {

using nlohmann::json;

/// A textured triangle of an archived material; its one image is RGBA.
SceneDescription import(const json& old, const json& also = json::object()) {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int texcoords = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  PngSource picture;
  picture.width = 2;
  picture.colour_type = 6;
  picture.samples = {10, 20, 30, 255, 40, 50, 60, 51};
  file.add("images", {{"bufferView", file.add_view(png_bytes(picture))}});
  file.add("samplers", {{"wrapS", 33071}});
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  json material = also;
  material["extensions"]["KHR_materials_pbrSpecularGlossiness"] = old;
  file.add("materials", material);
  file.add("materials", material);
  file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
  const json attributes = {{"POSITION", positions}, {"TEXCOORD_0", texcoords}};
  file.add_mesh(attributes, {{"material", 0}});
  file.add_mesh(attributes, {{"material", 1}});
  return file.import();
}

TEST(ImportSpecularGlossiness, BecomesADielectricOfItsSpecularColor) {
  const SceneDescription scene =
      import({{"diffuseFactor", {0.8, 0.1, 0.2, 0.5}},
              {"specularFactor", {0.04, 0.05, 0.06}},
              {"glossinessFactor", 0.25}},
             {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}});
  const MaterialDescription& m = scene.materials.at(0);
  EXPECT_EQ(m.base_color, Vec4f(0.8f, 0.1f, 0.2f, 0.5f));
  EXPECT_EQ(m.metallic, 0.f);
  EXPECT_EQ(m.roughness, 0.75f);
  EXPECT_EQ(m.ior, 0.f) << "makes the specular colour the reflectance itself (KHR_materials_ior)";
  EXPECT_EQ(m.specular, 1.f);
  EXPECT_EQ(m.specular_color, Rgb(0.04f, 0.05f, 0.06f));
  EXPECT_TRUE(has_notice(scene, "KHR_materials_pbrSpecularGlossiness is approximated"));
}

TEST(ImportSpecularGlossiness, HasTheDefaultsOfItsSpecification) {
  const MaterialDescription m = import(json::object()).materials.at(0);
  EXPECT_EQ(m.base_color, Vec4f(1, 1, 1, 1));
  EXPECT_EQ(m.specular_color, Rgb(1, 1, 1));
  EXPECT_EQ(m.roughness, 0.f);
}

TEST(ImportSpecularGlossiness, GlossinessTexturesBecomeRoughness) {
  const SceneDescription scene =
      import({{"glossinessFactor", 0.5},
              {"diffuseTexture", {{"index", 0}}},
              {"specularGlossinessTexture",
               {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.25, 0}}}}}}}}});
  const MaterialDescription& m = scene.materials.at(0);
  ASSERT_EQ(scene.textures.size(), 2u) << "two materials, but one derived texture";
  EXPECT_EQ(m.base_color_texture.texture, m.specular_color_texture.texture);
  EXPECT_NE(m.metallic_roughness_texture.texture, m.specular_color_texture.texture);
  EXPECT_EQ(m.metallic_roughness_texture.offset, Vec2f(0.25f, 0));
  EXPECT_EQ(m.roughness, 1.f) << "the factor is in the texture";
  const Texture& roughness = scene.textures.at(size_t(m.metallic_roughness_texture.texture));
  EXPECT_EQ(roughness.wrap_s(), WrapMode::clamp_to_edge);
  EXPECT_NEAR(roughness.sample({0.25f, 0.5f}, TexelEncoding::linear).y, 1 - 0.5, 0.51 / 255);
  EXPECT_NEAR(roughness.sample({0.75f, 0.5f}, TexelEncoding::linear).y, 1 - 0.5 * 51 / 255, 0.51 / 255);
  EXPECT_EQ(scene.materials.at(1).metallic_roughness_texture.texture, m.metallic_roughness_texture.texture);
}

}  // namespace
}  // namespace vernier::test
