// SPDX-License-Identifier: Apache-2.0
#include "scene/import/animated_property.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <set>

#include "scene/import/features.h"

namespace vernier {
namespace {

using nlohmann::json;

constexpr double unbounded = std::numeric_limits<float>::max();
constexpr const char* extension_name = "KHR_animation_pointer";

// Ranges are those whose ends the readers of a resting file leave to the schema; the others clamp themselves.
constexpr AnimatedProperty properties[] = {
    {"/nodes/{}/translation", 3},
    {"/nodes/{}/rotation", 4, -unbounded, unbounded, Blend::spherical},
    {"/nodes/{}/scale", 3},
    {"/nodes/{}/weights", 0},
    {"/nodes/{}/weights/{}"},
    {"/nodes/{}/extensions/KHR_node_visibility/visible", 1, 0, 1, Blend::step},
    {"/meshes/{}/weights", 0},
    {"/meshes/{}/weights/{}"},

    {"/cameras/{}/perspective/yfov", 1, 1e-6},
    {"/cameras/{}/perspective/aspectRatio", 1, 1e-6},
    {"/cameras/{}/perspective/znear"},
    {"/cameras/{}/perspective/zfar"},
    {"/cameras/{}/orthographic/xmag"},
    {"/cameras/{}/orthographic/ymag"},
    {"/cameras/{}/orthographic/znear"},
    {"/cameras/{}/orthographic/zfar"},

    {"/extensions/KHR_lights_punctual/lights/{}/color", 3},
    {"/extensions/KHR_lights_punctual/lights/{}/intensity"},
    {"/extensions/KHR_lights_punctual/lights/{}/range", 1, 1e-30},
    {"/extensions/KHR_lights_punctual/lights/{}/spot/innerConeAngle", 1, 0},
    {"/extensions/KHR_lights_punctual/lights/{}/spot/outerConeAngle", 1, 0},
    {"/extensions/EXT_lights_image_based/lights/{}/intensity", 1, 0},
    {"/extensions/EXT_lights_image_based/lights/{}/rotation", 4, -unbounded, unbounded, Blend::spherical},

    {"/materials/{}/alphaCutoff", 1, 0},
    {"/materials/{}/emissiveFactor", 3},
    {"/materials/{}/normalTexture/scale"},
    {"/materials/{}/occlusionTexture/strength"},
    {"/materials/{}/pbrMetallicRoughness/baseColorFactor", 4},
    {"/materials/{}/pbrMetallicRoughness/metallicFactor"},
    {"/materials/{}/pbrMetallicRoughness/roughnessFactor"},
    {"/materials/{}/extensions/KHR_materials_anisotropy/anisotropyStrength"},
    {"/materials/{}/extensions/KHR_materials_anisotropy/anisotropyRotation"},
    {"/materials/{}/extensions/KHR_materials_clearcoat/clearcoatFactor"},
    {"/materials/{}/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor"},
    {"/materials/{}/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale"},
    {"/materials/{}/extensions/KHR_materials_diffuse_roughness/diffuseRoughnessFactor"},
    {"/materials/{}/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor"},
    {"/materials/{}/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor", 3},
    {"/materials/{}/extensions/KHR_materials_dispersion/dispersion"},
    {"/materials/{}/extensions/KHR_materials_emissive_strength/emissiveStrength"},
    {"/materials/{}/extensions/KHR_materials_ior/ior", 1, 0},
    {"/materials/{}/extensions/KHR_materials_iridescence/iridescenceFactor"},
    {"/materials/{}/extensions/KHR_materials_iridescence/iridescenceIor"},
    {"/materials/{}/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum"},
    {"/materials/{}/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum"},
    {"/materials/{}/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", 4},
    {"/materials/{}/extensions/KHR_materials_pbrSpecularGlossiness/specularFactor", 3},
    {"/materials/{}/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor"},
    {"/materials/{}/extensions/KHR_materials_scatter/scatterStrengthFactor"},
    {"/materials/{}/extensions/KHR_materials_scatter/multiscatterColorFactor", 3},
    {"/materials/{}/extensions/KHR_materials_scatter/scatterAnisotropy", 1, -1},
    {"/materials/{}/extensions/KHR_materials_sheen/sheenColorFactor", 3},
    {"/materials/{}/extensions/KHR_materials_sheen/sheenRoughnessFactor"},
    {"/materials/{}/extensions/KHR_materials_specular/specularFactor"},
    {"/materials/{}/extensions/KHR_materials_specular/specularColorFactor", 3},
    {"/materials/{}/extensions/KHR_materials_transmission/transmissionFactor"},
    {"/materials/{}/extensions/KHR_materials_volume/thicknessFactor", 1, 0},
    {"/materials/{}/extensions/KHR_materials_volume/attenuationDistance"},
    {"/materials/{}/extensions/KHR_materials_volume/attenuationColor", 3},
    {"/materials/{}/extensions/KHR_materials_volume_scatter/multiscatterColor", 3},
    {"/materials/{}/extensions/KHR_materials_volume_scatter/scatterAnisotropy", 1, -1},
};

// Of any texture of a material, whose path comes before.
constexpr AnimatedProperty texture_properties[] = {
    {"/extensions/KHR_texture_transform/offset", 2},
    {"/extensions/KHR_texture_transform/rotation"},
    {"/extensions/KHR_texture_transform/scale", 2},
};

std::vector<std::string_view> split(std::string_view pointer) {
  std::vector<std::string_view> tokens;
  while (!pointer.empty()) {
    const size_t end = std::min(pointer.find('/', 1), pointer.size());
    tokens.push_back(pointer.substr(1, end - 1));
    pointer.remove_prefix(end);
  }
  return tokens;
}

/// An array index as JSON pointers write them (RFC 6901): digits without leading zeros.
std::optional<size_t> to_index(std::string_view token) {
  size_t index = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), index);
  const bool whole = error == std::errc() && end == token.data() + token.size() && !token.empty();
  if (!whole || (token.size() > 1 && token[0] == '0')) return std::nullopt;
  return index;
}

/// The indices where a pointer fits a pattern; none where it does not.
std::optional<std::vector<size_t>> match(std::string_view pattern, std::string_view pointer) {
  // Rules out most at once: files may have many channels.
  if (!pointer.starts_with(pattern.substr(0, pattern.find("{}")))) return std::nullopt;
  const auto expected = split(pattern), found = split(pointer);
  if (expected.size() != found.size()) return std::nullopt;
  std::vector<size_t> indices;
  for (size_t i = 0; i < found.size(); ++i) {
    if (expected[i] != "{}") {
      if (expected[i] != found[i]) return std::nullopt;
      continue;
    }
    const auto index = to_index(found[i]);
    if (!index) return std::nullopt;
    indices.push_back(*index);
  }
  return indices;
}

bool file_has(const Document& document, std::string_view pointer) {
  const json* parts = document.animatable();
  return parts && parts->contains(json::json_pointer(std::string(pointer)));
}

/// Whether the file has what the property belongs to. Objects whose absence stands for their default values
/// need not be there themselves.
bool has_owner(const Document& document, std::string_view pointer) {
  const auto last_of = [](std::string_view path) { return path.substr(path.rfind('/') + 1); };
  std::string_view owner = pointer.substr(0, pointer.rfind('/'));
  if (last_of(owner).starts_with("KHR_materials_")) owner = owner.substr(0, owner.find("/extensions"));
  if (last_of(owner) == "pbrMetallicRoughness") owner = owner.substr(0, owner.rfind('/'));
  return file_has(document, owner);
}

size_t morph_target_count(const tinygltf::Mesh& mesh) {
  return mesh.primitives.empty() ? 0 : mesh.primitives[0].targets.size();
}

bool is_in_file(const Document& document, const AnimationTarget& target) {
  const auto& model = document.model();
  const bool of_node = target.pointer.starts_with("/nodes/");
  if (!of_node && !target.pointer.starts_with("/meshes/")) return has_owner(document, target.pointer);
  int mesh = int(target.indices[0]);
  if (target.indices[0] >= (of_node ? document.nodes().size() : model.meshes.size())) return false;
  if (of_node) mesh = document.nodes()[target.indices[0]].mesh;
  if (target.indices.size() < 2) return true;
  return mesh >= 0 && target.indices[1] < morph_target_count(model.meshes[size_t(mesh)]);
}

/// "/materials/0/.../xTexture" of a texture transform's pointer, if there is such a texture.
bool is_texture(const Document& document, std::string_view pointer) {
  const auto tokens = split(pointer);
  if (tokens.size() < 3 || tokens[0] != "materials" || !tokens.back().ends_with("Texture")) return false;
  const bool known = tokens[2] != "extensions" ||
                     extension_use(std::string(tokens[3])).status != FeatureUse::Status::ignored;
  return known && file_has(document, pointer);
}

}  // namespace

std::string channel_pointer(const tinygltf::AnimationChannel& channel) {
  if (channel.target_path != "pointer")
    return channel.target_node < 0 ? ""
                                   : fmt::format("/nodes/{}/{}", channel.target_node, channel.target_path);
  const auto extension = channel.target_extensions.find(extension_name);
  return extension == channel.target_extensions.end() ? ""
                                                      : extension->second.Get("pointer").Get<std::string>();
}

std::optional<AnimationTarget> find_target(const Document& document, const std::string& pointer) {
  if (!pointer.starts_with('/')) return std::nullopt;
  for (const auto& property : properties)
    if (auto indices = match(property.pattern, pointer)) {
      AnimationTarget target{pointer, &property, std::move(*indices)};
      return is_in_file(document, target) ? std::optional(std::move(target)) : std::nullopt;
    }
  for (const auto& property : texture_properties)
    if (pointer.ends_with(property.pattern) &&
        is_texture(document, std::string_view(pointer).substr(0, pointer.size() - property.pattern.size())))
      return AnimationTarget{pointer, &property, {}};
  return std::nullopt;
}

void note_unknown_pointers(const Document& document, std::vector<FeatureUse>& features) {
  std::set<std::string> unknown;
  for (const auto& animation : document.model().animations)
    for (const auto& channel : animation.channels)
      if (channel.target_path == "pointer" && !find_target(document, channel_pointer(channel)))
        unknown.insert(channel_pointer(channel));
  if (unknown.empty()) return;
  const std::string more = unknown.size() > 1 ? fmt::format(" and {} more", unknown.size() - 1) : "";
  for (auto& feature : features)
    if (feature.name == extension_name)
      feature = {feature.name, FeatureUse::Status::approximated,
                 fmt::format("'{}'{} names nothing that the file has and that can be animated",
                             *unknown.begin(), more)};
}

}  // namespace vernier
