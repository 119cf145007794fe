// SPDX-License-Identifier: Apache-2.0
// The parts of the glTF 2.0 JSON schema (Khronos, "glTF 2.0 Specification", chapter 5) and of its extensions
// that the importer reads, as a table.

#include "scene/import/schema.h"

namespace vernier {
namespace {

using Kind = ValueRule::Kind;
// 2^53 and 2^31 - 1: sizes that survive a double, and those that tinygltf keeps in an int.
constexpr double max_size = 9007199254740992.0, max_int = 2147483647.0;
constexpr double infinity = std::numeric_limits<double>::infinity();

ValueRule boolean() { return {.kind = Kind::boolean}; }
ValueRule text(std::vector<std::string> names = {}) {
  return {.kind = Kind::text, .names = std::move(names)};
}
ValueRule number(double lower = -infinity, double upper = infinity) {
  return {.kind = Kind::number, .lower = lower, .upper = upper};
}
ValueRule integer(double lower, double upper) {
  return {.kind = Kind::integer, .lower = lower, .upper = upper};
}
ValueRule one_of(std::vector<int> values) { return {.kind = Kind::integer, .values = std::move(values)}; }
ValueRule size(double lower = 0) { return integer(lower, max_size); }
ValueRule index_into(std::string target) { return {.kind = Kind::index, .target = std::move(target)}; }
ValueRule object(const ObjectSchema& schema) { return {.kind = Kind::object, .object = &schema}; }
ValueRule array(ValueRule item, size_t min_items = 0) {
  return {.kind = Kind::array, .items = {std::move(item)}, .min_items = min_items};
}
ValueRule numbers(size_t count) {
  return {.kind = Kind::array, .items = {number()}, .min_items = count, .max_items = count};
}

constexpr bool required = true;

/// Each schema refers to those above it.
struct GltfSchema {
  const ValueRule accessor_index = index_into("/accessors"), view_index = index_into("/bufferViews");

  const ObjectSchema texture_transform{{{"offset", numbers(2)},
                                        {"scale", numbers(2)},
                                        {"rotation", number()},
                                        {"texCoord", integer(0, max_int)}},
                                       {}};
  const ObjectSchema texture_info_extensions{{{"KHR_texture_transform", object(texture_transform)}}, {}};
  const ObjectSchema texture_info{{{"index", index_into("/textures"), required},
                                   {"texCoord", integer(0, max_int)},
                                   {"scale", number()},
                                   {"strength", number()},
                                   {"extensions", object(texture_info_extensions)}},
                                  {}};
  const ValueRule texture = object(texture_info);

  const ObjectSchema emissive_strength{{{"emissiveStrength", number()}}, {}};
  const ObjectSchema ior{{{"ior", number(0)}}, {}};
  const ObjectSchema specular{{{"specularFactor", number()},
                               {"specularTexture", texture},
                               {"specularColorFactor", numbers(3)},
                               {"specularColorTexture", texture}},
                              {}};
  const ObjectSchema transmission{{{"transmissionFactor", number()}, {"transmissionTexture", texture}}, {}};
  const ObjectSchema volume{{{"thicknessFactor", number(0)},
                             {"thicknessTexture", texture},
                             {"attenuationDistance", number()},
                             {"attenuationColor", numbers(3)}},
                            {}};
  const ObjectSchema volume_scatter{{{"multiscatterColor", numbers(3)}, {"scatterAnisotropy", number()}}, {}};
  const ObjectSchema scatter{{{"scatterStrengthFactor", number()},
                              {"scatterStrengthTexture", texture},
                              {"multiscatterColorFactor", numbers(3)},
                              {"multiscatterColorTexture", texture},
                              {"scatterAnisotropy", number()}},
                             {}};
  const ObjectSchema clearcoat{{{"clearcoatFactor", number()},
                                {"clearcoatTexture", texture},
                                {"clearcoatRoughnessFactor", number()},
                                {"clearcoatRoughnessTexture", texture},
                                {"clearcoatNormalTexture", texture}},
                               {}};
  const ObjectSchema sheen{{{"sheenColorFactor", numbers(3)},
                            {"sheenColorTexture", texture},
                            {"sheenRoughnessFactor", number()},
                            {"sheenRoughnessTexture", texture}},
                           {}};
  const ObjectSchema anisotropy{
      {{"anisotropyStrength", number()}, {"anisotropyRotation", number()}, {"anisotropyTexture", texture}},
      {}};
  const ObjectSchema iridescence{{{"iridescenceFactor", number()},
                                  {"iridescenceTexture", texture},
                                  {"iridescenceIor", number()},
                                  {"iridescenceThicknessMinimum", number()},
                                  {"iridescenceThicknessMaximum", number()},
                                  {"iridescenceThicknessTexture", texture}},
                                 {}};
  const ObjectSchema dispersion{{{"dispersion", number()}}, {}};
  const ObjectSchema diffuse_roughness{
      {{"diffuseRoughnessFactor", number()}, {"diffuseRoughnessTexture", texture}}, {}};
  const ObjectSchema diffuse_transmission{{{"diffuseTransmissionFactor", number()},
                                           {"diffuseTransmissionTexture", texture},
                                           {"diffuseTransmissionColorFactor", numbers(3)},
                                           {"diffuseTransmissionColorTexture", texture}},
                                          {}};
  const ObjectSchema specular_glossiness{{{"diffuseFactor", numbers(4)},
                                          {"diffuseTexture", texture},
                                          {"specularFactor", numbers(3)},
                                          {"glossinessFactor", number()},
                                          {"specularGlossinessTexture", texture}},
                                         {}};
  const ObjectSchema empty{};
  const ObjectSchema material_extensions{
      {{"KHR_materials_anisotropy", object(anisotropy)},
       {"KHR_materials_clearcoat", object(clearcoat)},
       {"KHR_materials_diffuse_roughness", object(diffuse_roughness)},
       {"KHR_materials_diffuse_transmission", object(diffuse_transmission)},
       {"KHR_materials_dispersion", object(dispersion)},
       {"KHR_materials_emissive_strength", object(emissive_strength)},
       {"KHR_materials_ior", object(ior)},
       {"KHR_materials_iridescence", object(iridescence)},
       {"KHR_materials_pbrSpecularGlossiness", object(specular_glossiness)},
       {"KHR_materials_scatter", object(scatter)},
       {"KHR_materials_sheen", object(sheen)},
       {"KHR_materials_specular", object(specular)},
       {"KHR_materials_transmission", object(transmission)},
       {"KHR_materials_unlit", object(empty)},
       {"KHR_materials_volume", object(volume)},
       {"KHR_materials_volume_scatter", object(volume_scatter)}},
      {}};
  const ObjectSchema metallic_roughness{{{"baseColorFactor", numbers(4)},
                                         {"baseColorTexture", texture},
                                         {"metallicFactor", number()},
                                         {"roughnessFactor", number()},
                                         {"metallicRoughnessTexture", texture}},
                                        {}};
  const ObjectSchema material{{{"name", text()},
                               {"pbrMetallicRoughness", object(metallic_roughness)},
                               {"normalTexture", texture},
                               {"occlusionTexture", texture},
                               {"emissiveTexture", texture},
                               {"emissiveFactor", numbers(3)},
                               {"alphaMode", text({"OPAQUE", "MASK", "BLEND"})},
                               {"alphaCutoff", number()},
                               {"doubleSided", boolean()},
                               {"extensions", object(material_extensions)}},
                              {}};

  const ObjectSchema image{
      {{"uri", text()}, {"bufferView", view_index}, {"mimeType", text()}, {"name", text()}}, {}};
  const ObjectSchema sampler{{{"magFilter", one_of({9728, 9729})},
                              {"minFilter", one_of({9728, 9729, 9984, 9985, 9986, 9987})},
                              {"wrapS", one_of({10497, 33071, 33648})},
                              {"wrapT", one_of({10497, 33071, 33648})},
                              {"name", text()}},
                             {}};
  const ObjectSchema texture_source{{{"source", index_into("/images"), required}}, {}};
  const ObjectSchema texture_extensions{{{"EXT_texture_avif", object(texture_source)},
                                         {"EXT_texture_webp", object(texture_source)},
                                         {"KHR_texture_basisu", object(texture_source)}},
                                        {}};
  const ObjectSchema texture_object{{{"sampler", index_into("/samplers")},
                                     {"source", index_into("/images")},
                                     {"name", text()},
                                     {"extensions", object(texture_extensions)}},
                                    {}};

  const ObjectSchema meshopt_fallback{{{"fallback", boolean()}}, {}};
  const ObjectSchema buffer_extensions{{{"EXT_meshopt_compression", object(meshopt_fallback)},
                                        {"KHR_meshopt_compression", object(meshopt_fallback)}},
                                       {}};
  const ObjectSchema buffer{{{"uri", text()},
                             {"byteLength", size(1), required},
                             {"name", text()},
                             {"extensions", object(buffer_extensions)}},
                            {}};
  const ObjectSchema meshopt{{{"buffer", index_into("/buffers"), required},
                              {"byteOffset", integer(0, max_int)},
                              {"byteLength", integer(1, max_int), required},
                              {"byteStride", integer(1, 256), required},
                              {"count", integer(1, max_int), required},
                              {"mode", text(), required},
                              {"filter", text()}},
                             {}};
  const ObjectSchema view_extensions{
      {{"EXT_meshopt_compression", object(meshopt)}, {"KHR_meshopt_compression", object(meshopt)}}, {}};
  const ObjectSchema buffer_view{{{"buffer", index_into("/buffers"), required},
                                  {"byteOffset", size()},
                                  {"byteLength", size(1), required},
                                  {"byteStride", integer(4, 252)},
                                  {"name", text()},
                                  {"extensions", object(view_extensions)}},
                                 {}};
  const ObjectSchema sparse_indices{{{"bufferView", view_index, required},
                                     {"byteOffset", integer(0, max_int)},
                                     {"componentType", one_of({5121, 5123, 5125}), required}},
                                    {}};
  const ObjectSchema sparse_values{
      {{"bufferView", view_index, required}, {"byteOffset", integer(0, max_int)}}, {}};
  const ObjectSchema sparse{{{"count", integer(1, max_int), required},
                             {"indices", object(sparse_indices), required},
                             {"values", object(sparse_values), required}},
                            {}};
  const ObjectSchema accessor{
      {{"bufferView", view_index},
       {"byteOffset", size()},
       {"componentType", one_of({5120, 5121, 5122, 5123, 5125, 5126}), required},
       {"normalized", boolean()},
       {"count", size(1), required},
       {"type", text({"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}), required},
       {"sparse", object(sparse)},
       {"name", text()}},
      {}};

  const ObjectSchema attributes{{}, {accessor_index}};
  const ObjectSchema draco_attributes{{}, {integer(0, max_int)}};
  const ObjectSchema draco{
      {{"bufferView", view_index, required}, {"attributes", object(draco_attributes), required}}, {}};
  const ObjectSchema variant_mapping{
      {{"material", index_into("/materials"), required},
       {"variants", array(index_into("/extensions/KHR_materials_variants/variants")), required}},
      {}};
  const ObjectSchema variant_mappings{{{"mappings", array(object(variant_mapping)), required}}, {}};
  const ObjectSchema primitive_extensions{
      {{"KHR_draco_mesh_compression", object(draco)}, {"KHR_materials_variants", object(variant_mappings)}},
      {}};
  const ObjectSchema primitive{{{"attributes", object(attributes), required},
                                {"indices", accessor_index},
                                {"material", index_into("/materials")},
                                {"mode", integer(0, 6)},
                                {"targets", array(object(attributes))},
                                {"extensions", object(primitive_extensions)}},
                               {}};
  const ObjectSchema mesh{
      {{"primitives", array(object(primitive), 1), required}, {"weights", array(number())}, {"name", text()}},
      {}};

  const ObjectSchema perspective{{{"yfov", number(1e-6), required},
                                  {"aspectRatio", number(1e-6)},
                                  {"znear", number(0), required},
                                  {"zfar", number(0)}},
                                 {}};
  const ObjectSchema orthographic{
      {{"xmag", number(), required}, {"ymag", number(), required}, {"znear", number()}, {"zfar", number()}},
      {}};
  const ObjectSchema camera{{{"type", text({"perspective", "orthographic"}), required},
                             {"perspective", object(perspective)},
                             {"orthographic", object(orthographic)},
                             {"name", text()}},
                            {}};

  const ObjectSchema spot{{{"innerConeAngle", number(0)}, {"outerConeAngle", number(0)}}, {}};
  const ObjectSchema light{{{"type", text({"point", "spot", "directional"}), required},
                            {"color", numbers(3)},
                            {"intensity", number()},
                            {"range", number(0)},
                            {"spot", object(spot)},
                            {"name", text()}},
                           {}};
  const ObjectSchema lights{{{"lights", array(object(light)), required}}, {}};
  const ObjectSchema light_use{{{"light", index_into("/extensions/KHR_lights_punctual/lights"), required}},
                               {}};

  const ObjectSchema instancing{{{"attributes", object(attributes), required}}, {}};
  const ObjectSchema visibility{{{"visible", boolean()}}, {}};
  const ObjectSchema node_extensions{{{"EXT_mesh_gpu_instancing", object(instancing)},
                                      {"KHR_lights_punctual", object(light_use)},
                                      {"KHR_node_visibility", object(visibility)}},
                                     {}};
  const ObjectSchema node{{{"children", array(index_into("/nodes"))},
                           {"mesh", index_into("/meshes")},
                           {"camera", index_into("/cameras")},
                           {"skin", index_into("/skins")},
                           {"matrix", numbers(16)},
                           {"translation", numbers(3)},
                           {"rotation", numbers(4)},
                           {"scale", numbers(3)},
                           {"weights", array(number())},
                           {"name", text()},
                           {"extensions", object(node_extensions)}},
                          {}};
  const ValueRule cube_faces{
      .kind = Kind::array, .items = {index_into("/images")}, .min_items = 6, .max_items = 6};
  const ObjectSchema image_light{{{"intensity", number(0)},
                                  {"rotation", numbers(4)},
                                  {"specularImageSize", integer(1, max_int), required},
                                  {"specularImages", array(cube_faces, 1), required},
                                  {"name", text()}},
                                 {}};
  const ObjectSchema image_lights{{{"lights", array(object(image_light)), required}}, {}};
  const ObjectSchema image_light_use{
      {{"light", index_into("/extensions/EXT_lights_image_based/lights"), required}}, {}};
  const ObjectSchema scene_extensions{{{"EXT_lights_image_based", object(image_light_use)}}, {}};
  const ObjectSchema scene{
      {{"nodes", array(index_into("/nodes"))}, {"name", text()}, {"extensions", object(scene_extensions)}},
      {}};
  const ObjectSchema skin{{{"joints", array(index_into("/nodes"), 1), required},
                           {"inverseBindMatrices", accessor_index},
                           {"skeleton", index_into("/nodes")},
                           {"name", text()}},
                          {}};

  const ObjectSchema animation_pointer{{{"pointer", text(), required}}, {}};
  const ObjectSchema target_extensions{{{"KHR_animation_pointer", object(animation_pointer)}}, {}};
  const ObjectSchema channel_target{
      {{"node", index_into("/nodes")}, {"path", text(), required}, {"extensions", object(target_extensions)}},
      {}};
  const ObjectSchema channel{
      {{"sampler", integer(0, max_int), required}, {"target", object(channel_target), required}}, {}};
  const ObjectSchema animation_sampler{{{"input", accessor_index, required},
                                        {"output", accessor_index, required},
                                        {"interpolation", text({"LINEAR", "STEP", "CUBICSPLINE"})}},
                                       {}};
  const ObjectSchema animation{{{"channels", array(object(channel)), required},
                                {"samplers", array(object(animation_sampler)), required},
                                {"name", text()}},
                               {}};

  const ObjectSchema asset{{{"version", text(), required}, {"minVersion", text()}}, {}};
  const ObjectSchema variant{{{"name", text(), required}}, {}};
  const ObjectSchema variants{{{"variants", array(object(variant)), required}}, {}};
  const ObjectSchema root_extensions{{{"EXT_lights_image_based", object(image_lights)},
                                      {"KHR_lights_punctual", object(lights)},
                                      {"KHR_materials_variants", object(variants)}},
                                     {}};
  const ObjectSchema root{{{"asset", object(asset), required},
                           {"extensionsUsed", array(text())},
                           {"extensionsRequired", array(text())},
                           {"scene", index_into("/scenes")},
                           {"scenes", array(object(scene))},
                           {"nodes", array(object(node))},
                           {"meshes", array(object(mesh))},
                           {"accessors", array(object(accessor))},
                           {"bufferViews", array(object(buffer_view))},
                           {"buffers", array(object(buffer))},
                           {"materials", array(object(material))},
                           {"textures", array(object(texture_object))},
                           {"images", array(object(image))},
                           {"samplers", array(object(sampler))},
                           {"cameras", array(object(camera))},
                           {"skins", array(object(skin))},
                           {"animations", array(object(animation))},
                           {"extensions", object(root_extensions)}},
                          {}};
};

}  // namespace

const ObjectSchema& gltf_schema() {
  static const GltfSchema schema;
  return schema.root;
}

}  // namespace vernier
