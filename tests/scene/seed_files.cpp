// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/seed_files.h"

#include "tests/scene/compressed_grids.h"
#include "tests/support/avif_files.h"
#include "tests/support/ktx2_files.h"
#include "tests/support/png_bytes.h"

namespace vernier::test {
namespace {

using nlohmann::json;

/// Everything that a material may have beside the usual.
json all_layers(const json& texture) {
  return {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatTexture", texture}}},
          {"KHR_materials_transmission", {{"transmissionFactor", 0.5}, {"transmissionTexture", texture}}},
          {"KHR_materials_volume", {{"attenuationDistance", 2}, {"thicknessFactor", 1}}},
          {"KHR_materials_volume_scatter", {{"multiscatterColor", {0.5, 0.2, 0.1}}}},
          {"KHR_materials_scatter", {{"scatterMean", 0.3}}},
          {"KHR_materials_ior", {{"ior", 1.3}}},
          {"KHR_materials_dispersion", {{"dispersion", 1}}},
          {"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}},
          {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorTexture", texture}}},
          {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}, {"anisotropyTexture", texture}}},
          {"KHR_materials_diffuse_roughness", {{"diffuseRoughnessFactor", 0.5}}},
          {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.5}}},
          {"KHR_materials_iridescence", {{"iridescenceFactor", 1}, {"iridescenceTexture", texture}}},
          {"KHR_materials_sheen", {{"sheenColorFactor", {1, 1, 1}}}},
          {"KHR_xmp_json_ld", {{"packet", 0}}}};
}

/// What is set by pointers: of a node, a material, a texture's place, a lamp and a camera.
void add_pointers(GltfFile& file, int times) {
  const int ramp = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  json channels = json::array();
  for (const char* pointer :
       {"/nodes/1/extensions/KHR_node_visibility/visible",
        "/materials/0/pbrMetallicRoughness/roughnessFactor", "/materials/0/normalTexture/scale",
        "/extensions/KHR_lights_punctual/lights/0/intensity", "/cameras/0/perspective/yfov"}) {
    const json extension = {{"KHR_animation_pointer", {{"pointer", pointer}}}};
    channels.push_back({{"sampler", 0}, {"target", {{"path", "pointer"}, {"extensions", extension}}}});
  }
  file.add("animations", {{"channels", channels}, {"samplers", {{{"input", times}, {"output", ramp}}}}});
}

/// A triangle with one texture, whose image an extension names.
GltfFile with_picture(const std::vector<uint8_t>& bytes, const char* mime_type, const char* extension) {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int coordinates = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  file.add("images", {{"bufferView", file.add_view(bytes)}, {"mimeType", mime_type}});
  file.add("textures", {{"extensions", {{extension, {{"source", 0}}}}}});
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  file.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", coordinates}}, {{"material", 0}});
  file.json["extensionsUsed"] = {extension};
  return animated(std::move(file));
}

GltfFile with_ktx2(const char* fixture) {
  return with_picture(ktx2_fixture(fixture), "image/ktx2", "KHR_texture_basisu");
}

/// The buffer is the .glb's own, and said to be as long as it is.
GltfFile as_glb(GltfFile file) {
  json& buffer = file.json["buffers"][0];
  buffer["byteLength"] = file.buffer.size();
  buffer.erase("uri");
  return file;
}

}  // namespace

GltfFile everything() {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int normals = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int coordinates = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  const int colors =
      file.add_accessor(std::vector<uint8_t>{255, 0, 0, 255, 0, 9, 0, 255, 5, 5, 5, 99}, "VEC4", true);
  const int color_changes = file.add_accessor(std::vector<float>(9, 0.5f), "VEC3");
  const int joints = file.add_accessor(std::vector<uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
  const int weights = file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0}, "VEC4");
  const int indices = file.add_accessor(std::vector<uint16_t>{0, 1, 2, 2, 1, 0}, "SCALAR");
  const int lift = file.add_accessor(std::vector<float>{0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3");
  const int moved = file.add_view(std::vector<uint16_t>{1, 2});
  const int moved_to = file.add_view(std::vector<float>{5, 6, 7, 8, 9, 10});
  file.json["accessors"][size_t(lift)]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", moved}, {"componentType", 5123}}},
      {"values", {{"bufferView", moved_to}}}};
  PngSource picture;
  picture.samples = {200, 100, 50};
  file.add("images", {{"bufferView", file.add_view(png_bytes(picture))}, {"mimeType", "image/png"}});
  file.add("samplers", {{"wrapS", 33071}, {"magFilter", 9728}});
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  const json turned = {{"offset", {0.5, 0}}, {"rotation", 0.3}, {"scale", {2, 2}}};
  const json texture = {{"index", 0}, {"extensions", {{"KHR_texture_transform", turned}}}};
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", texture}, {"roughnessFactor", 0.4}}},
                         {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                         {"emissiveFactor", {1, 0.5, 0}},
                         {"alphaMode", "MASK"},
                         {"extensions", all_layers(texture)}});
  const json attributes = {{"POSITION", positions}, {"NORMAL", normals},  {"TEXCOORD_0", coordinates},
                           {"COLOR_0", colors},     {"JOINTS_0", joints}, {"WEIGHTS_0", weights}};
  file.add_mesh(attributes,
                {{"indices", indices},
                 {"material", 0},
                 {"targets", {{{"POSITION", lift}, {"COLOR_0", color_changes}}, {{"NORMAL", normals}}}}});
  file.json["meshes"][0]["weights"] = {0.5, 0.25};
  const int matrices = file.add_accessor(std::vector<float>(32, 0.25f), "MAT4");
  file.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", matrices}});
  file.json["nodes"][0]["skin"] = 0;
  file.add_root({{"translation", {0, 0, 10}}, {"children", {2}}});
  file.add("nodes", {{"rotation", {0, 0, 0.6, 0.8}}, {"scale", {2, 2, 2}}});
  const int places = file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0}, "VEC3");
  file.add_root({{"mesh", 0},
                 {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
  file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
  file.add_root({{"camera", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1}}});
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"range", 9}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}};
  file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const int times = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  file.add("animations",
           {{"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}},
            {"samplers", {{{"input", times}, {"output", places}}}}});
  file.add("animations", {{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "scale"}}}}}},
                          {"samplers", {{{"input", times}, {"output", places}}}}});
  file.add("images", {{"uri", "data:image/png;BASE64,iVBORw0KGgo%3D"}});
  file.add("textures", {{"source", 1}});
  const json old = {{"specularGlossinessTexture", {{"index", 0}, {"texCoord", 2}}},
                    {"diffuseTexture", {{"index", 1}}},
                    {"glossinessFactor", 0.5},
                    {"specularFactor", {0.1, 0.2, 0.3}}};
  file.add("materials", {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", old}}}});
  file.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", coordinates}, {"TEXCOORD_2", coordinates}},
                {{"material", 1}});
  file.add_root(
      {{"mesh", 1}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"_ID", times}}}}}}}});
  for (const int mode : {0, 1, 5})
    file.add_mesh({{"POSITION", positions}, {"COLOR_0", colors}}, {{"mode", mode}, {"material", 1}});
  json& primitive = file.json["meshes"][1]["primitives"][0];
  primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 0}, {"variants", {0}}}};
  file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "other"}}};
  file.json["extensions"]["KHR_xmp_json_ld"]["packets"] = {{{"dc:title", "all"}}};
  const json harmonics = json(std::vector<std::vector<float>>(9, {0.5f, 0.25f, 0.125f}));
  file.json["extensions"]["EXT_lights_image_based"]["lights"] = {{{"intensity", 2},
                                                                  {"rotation", {0, 0, 0, 1}},
                                                                  {"irradianceCoefficients", harmonics},
                                                                  {"specularImageSize", 1},
                                                                  {"specularImages", {{0, 0, 0, 0, 0, 0}}}}};
  file.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  file.json["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = true;
  add_pointers(file, times);
  file.json["extensionsUsed"] = {"KHR_lights_punctual",    "EXT_mesh_gpu_instancing", "KHR_texture_transform",
                                 "KHR_materials_variants", "EXT_lights_image_based",  "KHR_node_visibility",
                                 "KHR_animation_pointer"};
  return file;
}

GltfFile animated(GltfFile file) {
  const json linear = {{"input", file.add_accessor(std::vector<float>{0, 1}, "SCALAR")},
                       {"output", file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0}, "VEC3")}};
  file.add("animations",
           {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
            {"samplers", {linear}}});
  return file;
}

std::vector<SeedFile> seed_files() {
  std::vector<SeedFile> files{{"everything", everything()},
                              {"draco", animated(draco_grid(Grid(3)))},
                              {"meshopt", animated(meshopt_grid(Grid(3)))},
                              {"etc1s", with_ktx2("etc1s_alpha")},
                              {"uastc", with_ktx2("uastc_zstandard")},
                              {"avif", with_picture(avif_fixture("rgba"), "image/avif", "EXT_texture_avif")}};
  for (SeedFile& seed : files) seed.file = as_glb(std::move(seed.file));
  return files;
}

}  // namespace vernier::test
