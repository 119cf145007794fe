// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "scene/geometry.h"
#include "tests/scene/import_support.h"
#include "tests/support/png_bytes.h"

// Sets of texture coordinates, morphed attributes, and instances by attributes that nobody knows.

namespace vernier::test {
namespace {

using nlohmann::json;

/// A triangle with TEXCOORD_n = n + 1 everywhere for each n given.
GltfFile with_sets(const std::vector<int>& sets, const json& material) {
  GltfFile file;
  json attributes = {{"POSITION", file.add_accessor(GltfFile::triangle_positions(), "VEC3")}};
  for (const int n : sets)
    attributes["TEXCOORD_" + std::to_string(n)] =
        file.add_accessor(std::vector<float>(6, float(n + 1)), "VEC2");
  for (int i = 0; i < 4; ++i) {
    file.add("images", {{"uri", "gone.png"}});
    file.add("textures", {{"source", i}});
  }
  file.add("materials", material);
  file.add_mesh(attributes, {{"material", 0}});
  return file;
}

json use(int texcoord) { return {{"index", 0}, {"texCoord", texcoord}}; }

/// The value of the texture coordinates that a slot reads; 0: none.
float read_by(const SceneDescription& scene, const TextureUse& slot) {
  const MeshDescription& mesh = scene.meshes.at(0);
  if (size_t(slot.texcoord) >= mesh.texcoord_set_count()) return -1;
  const auto& set = mesh.texcoord_set(size_t(slot.texcoord));
  return set.empty() ? 0 : set[0].x;
}

TEST(ImportAttributes, AnyTwoSetsOfTextureCoordinatesAreRead) {
  for (const auto& [base, normal] :
       {std::pair(0, 0), std::pair(0, 1), std::pair(1, 0), std::pair(2, 2), std::pair(2, 0), std::pair(0, 3),
        std::pair(1, 3), std::pair(3, 1), std::pair(7, 5), std::pair(5, 7)}) {
    const GltfFile file =
        with_sets({0, 1, 2, 3, 5, 7}, {{"pbrMetallicRoughness", {{"baseColorTexture", use(base)}}},
                                       {"emissiveFactor", {1, 1, 1}},
                                       {"normalTexture", use(normal)}});
    const SceneDescription scene = file.import();
    const MaterialDescription& m = scene.materials.at(0);
    EXPECT_EQ(read_by(scene, m.base_color_texture), float(base + 1)) << base << " " << normal;
    EXPECT_TRUE(scene.meshes.at(0).more_texcoords.empty()) << "the two sets that cost least are enough";
  }
}

TEST(ImportAttributes, SetsOfTransformsCountToo) {
  json texture = use(0);
  texture["extensions"]["KHR_texture_transform"] = {{"texCoord", 4}};
  const SceneDescription scene =
      with_sets({0, 4}, {{"pbrMetallicRoughness", {{"baseColorTexture", texture}}}}).import();
  EXPECT_EQ(read_by(scene, scene.materials.at(0).base_color_texture), 5.f);
}

TEST(ImportAttributes, AnyNumberOfSetsIsRead) {
  const json extensions = {
      {"KHR_materials_sheen",
       {{"sheenColorFactor", {1, 1, 1}}, {"sheenColorTexture", use(1)}, {"sheenRoughnessTexture", use(6)}}},
      {"KHR_materials_specular", {{"specularTexture", use(11)}}}};
  GltfFile file = with_sets({1, 2, 3, 4, 6, 11}, {{"pbrMetallicRoughness", {{"baseColorTexture", use(3)}}},
                                                  {"normalTexture", use(2)},
                                                  {"emissiveFactor", {1, 1, 1}},
                                                  {"emissiveTexture", use(4)},
                                                  {"extensions", extensions}});
  // Slots whose image is missing are left out.
  file.json["images"][0] = {{"bufferView", file.add_view(png_bytes({.samples = {1, 2, 3}}))},
                            {"mimeType", "image/png"}};
  const SceneDescription scene = file.import();
  const MaterialDescription& m = scene.materials.at(0);
  EXPECT_EQ(read_by(scene, m.base_color_texture), 4.f);
  EXPECT_EQ(read_by(scene, m.emissive_texture), 5.f);
  EXPECT_EQ(read_by(scene, m.sheen_color_texture), 2.f);
  EXPECT_EQ(read_by(scene, m.sheen_roughness_texture), 7.f);
  EXPECT_EQ(read_by(scene, m.specular_texture), 12.f);
  EXPECT_EQ(scene.meshes.at(0).texcoord_set_count(), 6u);
  EXPECT_TRUE(scene.notices.empty() || !has_notice(scene, "texture coordinates"));
}

/// What a texture shows of a set beyond the second is what it would show of the first.
TEST(ImportAttributes, FurtherSetsAreInterpolated) {
  GltfFile file;
  const std::vector<float> corner_uv{0.1f, 0.2f, 0.9f, 0.3f, 0.4f, 0.8f};
  json attributes = {{"POSITION", file.add_accessor(GltfFile::triangle_positions(), "VEC3")}};
  for (const char* name : {"TEXCOORD_0", "TEXCOORD_1"})
    attributes[name] = file.add_accessor(std::vector<float>(6, 0.5f), "VEC2");
  attributes["TEXCOORD_2"] = file.add_accessor(corner_uv, "VEC2");
  file.add("images",
           {{"bufferView", file.add_view(png_bytes({.width = 2, .samples = {0, 50, 99, 200, 7, 80}}))},
            {"mimeType", "image/png"}});
  file.add("textures", {{"source", 0}});
  file.add("materials",
           {{"pbrMetallicRoughness", {{"baseColorTexture", use(0)}, {"metallicRoughnessTexture", use(1)}}},
            {"emissiveFactor", {1, 1, 1}},
            {"emissiveTexture", use(2)}});
  file.add_mesh(attributes, {{"material", 0}});
  const SceneDescription scene = file.import();
  const Material material(scene.materials.at(0), scene.textures, false);
  const SceneGeometry geometry(scene.meshes, scene.instances);
  for (const Vec2f& at : {Vec2f(0, 0), Vec2f(0.2f, 0.3f), Vec2f(0.6f, 0.4f)}) {
    const auto on = [&](int axis) {
      return corner_uv[size_t(axis)] * (1 - at.x - at.y) + corner_uv[size_t(2 + axis)] * at.x +
             corner_uv[size_t(4 + axis)] * at.y;
    };
    const Vec4f expected = scene.textures.at(size_t(scene.materials[0].emissive_texture.texture))
                               .sample({on(0), on(1)}, TexelEncoding::srgb);
    const Rgb emitted = material.emission(geometry.attributes(geometry.surface_point(0, 0, at)), true, 1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(emitted[c], expected[c], 1e-6f);
  }
}

TEST(ImportAttributes, MissingSetsAreSaid) {
  const SceneDescription scene =
      with_sets({0}, {{"pbrMetallicRoughness", {{"baseColorTexture", use(2)}}}}).import();
  EXPECT_EQ(read_by(scene, scene.materials.at(0).base_color_texture), 0.f);
  EXPECT_TRUE(has_notice(scene, "lack texture coordinates"));
}

/// A coloured, textured triangle with one morph target of the attributes given.
GltfFile morphed(const json& target, GltfFile file, int colors, double weight) {
  const json attributes = {{"POSITION", file.add_accessor(GltfFile::triangle_positions(), "VEC3")},
                           {"COLOR_0", colors},
                           {"TEXCOORD_2", file.add_accessor(std::vector<float>(6, 0.5f), "VEC2")}};
  file.add("images", {{"uri", "gone.png"}});
  file.add("textures", {{"source", 0}});
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", use(2)}}}});
  file.add_mesh(attributes, {{"material", 0}, {"targets", {target}}});
  file.json["meshes"][0]["weights"] = {weight};
  return file;
}

TEST(ImportAttributes, ColorsMorph) {
  for (const std::string type : {"VEC3", "VEC4"})
    for (const std::string target_type : {"VEC3", "VEC4"}) {
      GltfFile file;
      const size_t n = type == "VEC3" ? 9 : 12, target_n = target_type == "VEC3" ? 9 : 12;
      const int colors = file.add_accessor(std::vector<float>(n, 0.5f), type);
      const int deltas = file.add_accessor(std::vector<float>(target_n, 0.25f), target_type);
      const float alpha = type == "VEC3" ? 1 : target_type == "VEC3" ? 0.5f : 0.625f;
      EXPECT_EQ(morphed({{"COLOR_0", deltas}}, file, colors, 0.5).import().meshes.at(0).colors.at(2),
                Vec4f(0.625f, 0.625f, 0.625f, alpha))
          << type << " " << target_type;
    }
}

TEST(ImportAttributes, MorphedColorsStayWithinOne) {
  GltfFile file;
  const int white = file.add_accessor(std::vector<float>(9, 1.f), "VEC3");
  const int deltas = file.add_accessor(std::vector<float>{-4, 0, 4, -0.5f, 0, 0, 0, 0, 0}, "VEC3");
  const auto colors = morphed({{"COLOR_0", deltas}}, file, white, 1).import().meshes.at(0).colors;
  ASSERT_EQ(colors.size(), 3u) << "white ones are morphed before they are found to be needless";
  EXPECT_EQ(colors[0], Vec4f(0, 1, 1, 1));
  EXPECT_EQ(colors[1], Vec4f(0.5f, 1, 1, 1));
  EXPECT_EQ(colors[2], Vec4f(1, 1, 1, 1));
}

TEST(ImportAttributes, AnySetOfTextureCoordinatesMorphs) {
  GltfFile file;
  const int white = file.add_accessor(std::vector<float>(9, 1.f), "VEC3");
  const int deltas = file.add_accessor(std::vector<float>(6, 2.f), "VEC2");
  const SceneDescription scene = morphed({{"TEXCOORD_2", deltas}}, file, white, 0.25).import();
  EXPECT_EQ(read_by(scene, scene.materials.at(0).base_color_texture), 1.f);
}

/// Three instances of a triangle by an accessor of each name.
GltfFile instanced(const std::vector<std::string>& names) {
  GltfFile file;
  json attributes = json::object();
  for (const auto& name : names)
    attributes[name] = name == "TRANSLATION"
                           ? file.add_accessor(std::vector<float>{1, 0, 0, 2, 0, 0, 3, 0, 0}, "VEC3")
                           : file.add_accessor(std::vector<uint16_t>{1, 2, 3}, "SCALAR");
  const int node = file.add_triangle();
  file.json["nodes"][size_t(node)]["translation"] = {0, 5, 0};
  file.json["nodes"][size_t(node)]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", attributes}};
  file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  return file;
}

TEST(ImportAttributes, UnknownAttributesMakeInstancesWhereTheNodeIs) {
  const SceneDescription scene = instanced({"_ID"}).import();
  ASSERT_EQ(scene.instances.size(), 3u);
  for (const auto& instance : scene.instances) EXPECT_EQ(instance.to_world.origin, Vec3f(0, 5, 0));
  EXPECT_EQ(instanced({"_ID", "TRANSLATION"}).import().instances.at(2).to_world.origin, Vec3f(3, 5, 0));
  EXPECT_EQ(instanced({}).import().instances.size(), 1u);
}

TEST(ImportAttributes, UnknownAttributesOfAnotherCountAreRefused) {
  GltfFile file = instanced({"_ID", "TRANSLATION"});
  file.json["accessors"][0]["count"] = 2;
  EXPECT_THAT(import_error(file), testing::HasSubstr("values for"));
}

TEST(ImportAttributes, ColorsInIntegersAreNormalizedSaidOrNot) {
  GltfFile file;
  const std::vector<uint8_t> colors{255, 51, 0, 255, 255, 51, 0, 255, 255, 51, 0, 255};
  file.add_mesh({{"POSITION", file.add_accessor(GltfFile::triangle_positions(), "VEC3")},
                 {"COLOR_0", file.add_accessor(colors, "VEC4")}});
  const SceneDescription scene = file.import();
  EXPECT_EQ(scene.meshes.at(0).colors.at(0), Vec4f(1, 0.2f, 0, 1));
  EXPECT_TRUE(has_notice(scene, "1 accessors of COLOR_0 hold integers that are not said to be normalized"));
}

}  // namespace
}  // namespace vernier::test
