// SPDX-License-Identifier: Apache-2.0
#include "scene/import/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "scene/import/tinygltf.h"

namespace vernier {
namespace {

using Status = FeatureUse::Status;

struct ExtensionEntry {
  std::string_view name;
  Status status;
  std::string_view note;
};

/// What the renderer makes of each extension. One that is not here is not known at all.
constexpr ExtensionEntry extensions[] = {
    {"EXT_lights_image_based", Status::approximated,
     "the sharpest cube map lights everything, at its own resolution (Prefiltered Specular Radiance "
     "Cubemaps); light "
     "paths blur it themselves, so blurred ones and Irradiance Coefficients are not used"},
    {"EXT_mesh_gpu_instancing", Status::exact, ""},
    {"EXT_meshopt_compression", Status::exact, ""},
    {"EXT_texture_avif", Status::exact, "8, 10 and 12 bits a channel; turning and mirroring are left out"},
    {"EXT_texture_webp", Status::exact, ""},
    {"KHR_animation_pointer", Status::exact,
     "numbers of materials and their textures, lights, cameras, nodes and morph weights; visibility"},
    {"KHR_draco_mesh_compression", Status::exact, ""},
    {"KHR_lights_punctual", Status::exact, "candela and lux are taken as W/sr and W/m^2"},
    {"KHR_materials_anisotropy", Status::exact, ""},
    {"KHR_materials_clearcoat", Status::exact,
     "reflects by the angle of the viewer alone (Layering), emission is darkened (Emission)"},
    {"KHR_materials_diffuse_roughness", Status::exact,
     "draft of 2025; the energy-preserving model of Oren and Nayar that it points to (EON)"},
    {"KHR_materials_diffuse_transmission", Status::exact, ""},
    {"KHR_materials_dispersion", Status::approximated,
     "one index each for red, green and blue (Implementation), not one a wavelength"},
    {"KHR_materials_iridescence", Status::exact,
     "per facet, with the extension's own simplified Fresnel terms (Iridescence Fresnel)"},
    {"KHR_materials_pbrSpecularGlossiness", Status::approximated,
     "archived; its specular colour becomes that of a dielectric (KHR_materials_specular with an index of 0) "
     "and 1 - glossiness its roughness; the layer takes from the diffuse colour what it reflects to each "
     "side, not the same to all"},
    {"KHR_materials_scatter", Status::approximated,
     "draft of June 2026, which takes the place of KHR_materials_volume_scatter; volumes by their factors, "
     "no textures; thin walls keep their clear transmission"},
    {"KHR_materials_sheen", Status::exact,
     "Charlie with two-sided albedo scaling (Sheen layering); roughness below 0.05 is taken for that"},
    {"KHR_materials_emissive_strength", Status::exact, "factor times strength is radiance in W/(m^2 sr)"},
    {"KHR_materials_ior", Status::exact, ""},
    {"KHR_materials_specular", Status::exact, ""},
    {"KHR_materials_transmission", Status::exact, "thin walls let light pass straight through"},
    {"KHR_materials_unlit", Status::exact, ""},
    {"KHR_materials_volume", Status::exact,
     "the mesh is the boundary, so thickness only tells volumes from thin walls; the smaller of two volumes "
     "that "
     "overlap is there"},
    {"KHR_materials_volume_scatter", Status::exact,
     "draft of July 2025; light walks at random below the surface, the multiple-scattering color becomes the "
     "albedo of one scattering as the draft says"},
    {"KHR_materials_variants", Status::exact, "one variant at a time, by name"},
    {"KHR_meshopt_compression", Status::exact, "as far as the library decodes it, else refused"},
    {"KHR_mesh_quantization", Status::exact, ""},
    {"KHR_node_visibility", Status::exact, ""},
    {"KHR_texture_basisu", Status::exact,
     "the base level is read; the samples of a pixel average the texels they meet"},
    {"KHR_texture_transform", Status::exact, ""},
    {"KHR_xmp_json_ld", Status::exact, "metadata, nothing to render"},

    {"MSFT_lod", Status::ignored, "the most detailed level is rendered"},
};

struct CoreEntry {
  std::string_view name;
  Status status;
  std::string_view note;
  bool (*used)(const tinygltf::Model&);
};

bool uses_occlusion(const tinygltf::Model& model) {
  return std::any_of(model.materials.begin(), model.materials.end(),
                     [](const auto& material) { return material.occlusionTexture.index >= 0; });
}

bool uses_morph_targets(const tinygltf::Model& model) {
  for (const auto& mesh : model.meshes)
    for (const auto& primitive : mesh.primitives)
      if (!primitive.targets.empty()) return true;
  return false;
}

bool uses_thin_primitives(const tinygltf::Model& model) {
  for (const auto& mesh : model.meshes)
    for (const auto& primitive : mesh.primitives)
      if (primitive.mode < TINYGLTF_MODE_TRIANGLES) return true;
  return false;
}

bool uses_more_colors(const tinygltf::Model& model) {
  for (const auto& mesh : model.meshes)
    for (const auto& primitive : mesh.primitives)
      if (primitive.attributes.count("COLOR_1")) return true;
  return false;
}

bool uses_mipmaps(const tinygltf::Model& model) {
  return std::any_of(model.samplers.begin(), model.samplers.end(),
                     [](const auto& sampler) { return sampler.minFilter >= 9984; });
}

constexpr CoreEntry core_features[] = {
    {"animations", Status::exact,
     "the scene is at rest unless --at gives a time; then --animation says by which one, or by all, it is "
     "posed",
     [](const tinygltf::Model& model) { return !model.animations.empty(); }},
    {"material.occlusionTexture", Status::ignored,
     "light transport computes occlusion itself (glTF 2.0, 3.9.3)", uses_occlusion},
    {"mesh.primitive.attributes COLOR_1 and up", Status::exact,
     "only COLOR_0 multiplies the base colour (glTF 2.0, 3.9.2); the others mean nothing", uses_more_colors},
    {"mesh.primitive.mode POINTS and LINES", Status::approximated,
     "they are solids in the scene, as thin as a pixel or a few when all of them fill the picture, not a "
     "pixel "
     "wide from anywhere; those without normals are not lit",
     uses_thin_primitives},
    {"mesh.primitive.targets", Status::exact, "morphed by the weights at that time", uses_morph_targets},
    {"sampler.minFilter mipmaps", Status::exact, "the samples of a pixel average the texels they meet",
     uses_mipmaps},
    {"skins", Status::exact, "posed by the joints at that time",
     [](const tinygltf::Model& model) { return !model.skins.empty(); }},
};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

FeatureUse extension_use(const std::string& name) {
  for (const auto& entry : extensions)
    if (entry.name == name) return {name, entry.status, std::string(entry.note)};
  return {name, Status::ignored, "this extension is not known"};
}

std::vector<FeatureUse> known_extensions() {
  std::vector<FeatureUse> known;
  for (const auto& [name, status, note] : extensions)
    known.push_back({std::string(name), status, std::string(note)});
  std::sort(known.begin(), known.end(),
            [](const FeatureUse& a, const FeatureUse& b) { return a.name < b.name; });
  return known;
}

std::vector<FeatureUse> report_features(const tinygltf::Model& model) {
  std::vector<FeatureUse> features;
  for (const auto& name : model.extensionsUsed) features.push_back(extension_use(name));
  for (const auto& name : model.extensionsRequired)
    if (!contains(model.extensionsUsed, name)) features.push_back(extension_use(name));
  for (const auto& entry : core_features)
    if (entry.used(model))
      features.push_back({std::string(entry.name), entry.status, std::string(entry.note)});
  return features;
}

void note_bent_light(SceneDescription& scene) {
  const auto bends = [&](const InstanceDescription& instance) {
    const MaterialDescription& m = scene.materials[instance.material];
    // What neither light paths and chains find, nor paths from the camera well (docs/caustics.md).
    const bool is_nearly_smooth = m.metallic_roughness_texture || (m.roughness > 0 && m.roughness < 0.1f);
    const bool has_normal_map = m.normal_texture || m.clearcoat_normal_texture;
    return m.transmission > 0 && m.bounds_volume() && m.ior != 1 && (is_nearly_smooth || has_normal_map);
  };
  if (scene.lights.empty() || std::none_of(scene.instances.begin(), scene.instances.end(), bends)) return;
  for (FeatureUse& feature : scene.features)
    if (feature.name == "KHR_lights_punctual")
      feature = {
          feature.name, Status::approximated,
          "of the light of lamps, what volumes with normal textures or of little roughness bend is found "
          "in part; renders tell how much is not"};
}

std::string describe(const FeatureUse& feature) {
  const char* how = feature.status == Status::ignored        ? "ignored"
                    : feature.status == Status::approximated ? "approximated"
                                                             : "exact";
  return fmt::format("{} is {}: {}", feature.name, how, feature.note);
}

std::vector<Notice> feature_notices(const std::vector<FeatureUse>& features) {
  std::vector<Notice> notices;
  for (const auto& feature : features) {
    if (feature.status == Status::exact) continue;
    const bool is_core = std::any_of(std::begin(core_features), std::end(core_features),
                                     [&](const CoreEntry& entry) { return entry.name == feature.name; });
    notices.push_back({is_core ? Notice::Severity::info : Notice::Severity::warning, "", describe(feature)});
  }
  return notices;
}

}  // namespace vernier
