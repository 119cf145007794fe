#include "apps/scene_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/notice_log.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

double degrees(float radians) { return double(radians) * 180 / std::numbers::pi; }

Json vector_json(const Vec3f& v) { return {v.x, v.y, v.z}; }

/// JSON has no infinity: null stands for it.
Json finite_or_null(float value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json camera_json(const CameraDescription& camera) {
  const bool perspective = camera.kind == CameraDescription::Kind::perspective;
  Json json = {{"name", camera.name}, {"kind", perspective ? "perspective" : "orthographic"}};
  if (perspective) {
    json["vertical_degrees"] = degrees(camera.yfov);
    if (camera.aspect > 0) json["aspect"] = camera.aspect;
  } else {
    json["half_width"] = camera.xmag;
    json["half_height"] = camera.ymag;
  }
  json["position"] = vector_json(camera.to_world.origin);
  json["direction"] = vector_json(-camera.to_world.z);
  return json;
}

std::string_view name(PunctualLightDescription::Kind kind) {
  switch (kind) {
    case PunctualLightDescription::Kind::point:
      return "point";
    case PunctualLightDescription::Kind::spot:
      return "spot";
    case PunctualLightDescription::Kind::directional:
      return "directional";
  }
  return "";
}

Json light_json(const PunctualLightDescription& light) {
  Json json = {{"name", light.name},
               {"kind", name(light.kind)},
               {"color", {light.color.x, light.color.y, light.color.z}},
               {"intensity", light.intensity},
               {"unit", light.kind == PunctualLightDescription::Kind::directional ? "W/m^2" : "W/sr"},
               {"range", finite_or_null(light.range)}};
  if (light.kind == PunctualLightDescription::Kind::spot) {
    json["inner_cone_degrees"] = degrees(light.inner_cone);
    json["outer_cone_degrees"] = degrees(light.outer_cone);
  }
  return json;
}

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

Json texture_names(const MaterialDescription& material) {
  const std::pair<const char*, const TextureUse*> slots[] = {
      {"base_color", &material.base_color_texture},
      {"metallic_roughness", &material.metallic_roughness_texture},
      {"normal", &material.normal_texture},
      {"emissive", &material.emissive_texture},
      {"specular", &material.specular_texture},
      {"specular_color", &material.specular_color_texture},
      {"transmission", &material.transmission_texture},
  };
  Json names = Json::array();
  for (const auto& [slot, use] : slots)
    if (*use) names.push_back(slot);
  return names;
}

std::string_view name(FeatureUse::Status status) {
  switch (status) {
    case FeatureUse::Status::exact:
      return "exact";
    case FeatureUse::Status::approximated:
      return "approximated";
    case FeatureUse::Status::ignored:
      return "ignored";
  }
  return "";
}

template <typename T>
Json list_json(const std::vector<T>& items, Json (*convert)(const T&)) {
  Json list = Json::array();
  for (const T& item : items) list.push_back(convert(item));
  return list;
}

Json feature_json(const FeatureUse& feature) {
  return {{"name", feature.name}, {"status", name(feature.status)}, {"note", feature.note}};
}

}  // namespace

Json material_json(const MaterialDescription& material) {
  const Vec4f& base = material.base_color;
  return {{"name", material.name},
          {"base_color", {base.x, base.y, base.z, base.w}},
          {"metallic", material.metallic},
          {"roughness", material.roughness},
          {"emissive", {material.emissive.x, material.emissive.y, material.emissive.z}},
          {"alpha_mode", name(material.alpha_mode)},
          {"double_sided", material.double_sided},
          {"unlit", material.unlit},
          {"ior", material.ior},
          {"specular", material.specular},
          {"transmission", material.transmission},
          {"thickness", material.thickness},
          {"attenuation_distance", finite_or_null(material.attenuation_distance)},
          {"textures", texture_names(material)}};
}

Json scene_json(const SceneDescription& scene, const SceneCounts& counts, const Bounds& bounds) {
  Json json = {
      {"file", scene.source}, {"hash", scene.hash}, {"counts", to_json(counts)}, {"bounds", nullptr}};
  if (!bounds.empty())
    json["bounds"] = {{"lower", vector_json(bounds.lower)}, {"upper", vector_json(bounds.upper)}};
  json["cameras"] = list_json(scene.cameras, camera_json);
  json["punctual_lights"] = list_json(scene.lights, light_json);
  json["materials"] = list_json(scene.materials, material_json);
  json["features"] = list_json(scene.features, feature_json);
  json["notices"] = to_json(scene.notices);
  return json;
}

}  // namespace vernier::apps
