// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "apps/vernier/scene_json.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

std::string_view name(AlphaMode mode) {
  switch (mode) {
    case AlphaMode::opaque:
      return "opaque";
    case AlphaMode::mask:
      return "mask";
    case AlphaMode::blend:
      return "blend";
  }
  return "";
}

Json texture_names(const MaterialDescription& m) {
  const std::pair<const char*, const TextureUse*> slots[] = {
      {"base_color", &m.base_color_texture},
      {"metallic_roughness", &m.metallic_roughness_texture},
      {"diffuse_roughness", &m.diffuse_roughness_texture},
      {"normal", &m.normal_texture},
      {"emissive", &m.emissive_texture},
      {"specular", &m.specular_texture},
      {"specular_color", &m.specular_color_texture},
      {"transmission", &m.transmission_texture},
      {"clearcoat", &m.clearcoat_texture},
      {"clearcoat_roughness", &m.clearcoat_roughness_texture},
      {"clearcoat_normal", &m.clearcoat_normal_texture},
      {"sheen_color", &m.sheen_color_texture},
      {"sheen_roughness", &m.sheen_roughness_texture},
      {"anisotropy", &m.anisotropy_texture},
      {"iridescence", &m.iridescence_texture},
      {"iridescence_thickness", &m.iridescence_thickness_texture},
      {"diffuse_transmission", &m.diffuse_transmission_texture},
      {"diffuse_transmission_color", &m.diffuse_transmission_color_texture},
  };
  Json names = Json::array();
  for (const auto& [slot, use] : slots)
    if (*use) names.push_back(slot);
  return names;
}

}  // namespace

Json material_json(const MaterialDescription& m) {
  return {{"name", m.name},
          {"base_color", vector_json(m.base_color)},
          {"metallic", number_json(m.metallic)},
          {"roughness", number_json(m.roughness)},
          {"diffuse_roughness", number_json(m.diffuse_roughness)},
          {"normal_scale", number_json(m.normal_scale)},
          {"emissive", vector_json(m.emissive)},
          {"alpha_mode", name(m.alpha_mode)},
          {"alpha_cutoff", number_json(m.alpha_cutoff)},
          {"double_sided", m.double_sided},
          {"unlit", m.unlit},
          {"ior", number_json(m.ior)},
          {"specular", number_json(m.specular)},
          {"specular_color", vector_json(m.specular_color)},
          {"transmission", number_json(m.transmission)},
          {"thickness", number_json(m.thickness)},
          {"attenuation_distance", number_json(m.attenuation_distance)},
          {"attenuation_color", vector_json(m.attenuation_color)},
          {"scattering_albedo", vector_json(m.scattering_albedo)},
          {"scattering_anisotropy", number_json(m.scattering_anisotropy)},
          {"clearcoat", number_json(m.clearcoat)},
          {"clearcoat_roughness", number_json(m.clearcoat_roughness)},
          {"sheen_color", vector_json(m.sheen_color)},
          {"sheen_roughness", number_json(m.sheen_roughness)},
          {"anisotropy", number_json(m.anisotropy)},
          {"anisotropy_rotation", number_json(m.anisotropy_rotation)},
          {"iridescence", number_json(m.iridescence)},
          {"iridescence_ior", number_json(m.iridescence_ior)},
          {"iridescence_thickness", {m.iridescence_thickness_min, m.iridescence_thickness_max}},
          {"dispersion", number_json(m.dispersion)},
          {"diffuse_transmission", number_json(m.diffuse_transmission)},
          {"diffuse_transmission_color", vector_json(m.diffuse_transmission_color)},
          {"textures", texture_names(m)}};
}

}  // namespace vernier::apps
