// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/scene_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/vernier/notice_log.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

double degrees(float radians) { return double(radians) * 180 / std::numbers::pi; }

Json camera_json(const CameraDescription& camera) {
  const bool perspective = camera.kind == CameraDescription::Kind::perspective;
  Json json = {{"name", camera.name}, {"kind", perspective ? "perspective" : "orthographic"}};
  if (perspective) {
    json["vertical_degrees"] = number_json(degrees(camera.yfov));
    if (camera.aspect > 0) json["aspect"] = number_json(camera.aspect);
  } else {
    json["half_width"] = number_json(camera.xmag);
    json["half_height"] = number_json(camera.ymag);
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
               {"color", vector_json(light.color)},
               {"intensity", number_json(light.intensity)},
               {"unit", light.kind == PunctualLightDescription::Kind::directional ? "W/m^2" : "W/sr"},
               {"range", number_json(light.range)}};
  if (light.kind == PunctualLightDescription::Kind::spot) {
    json["inner_cone_degrees"] = number_json(degrees(light.inner_cone));
    json["outer_cone_degrees"] = number_json(degrees(light.outer_cone));
  }
  return json;
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

Json features_json(const std::vector<FeatureUse>& features) { return list_json(features, feature_json); }

Json number_json(double value) {
  return std::isfinite(value) ? Json::parse(fmt::format("{}", static_cast<float>(value))) : Json(nullptr);
}

Json bounds_json(const Bounds& bounds) {
  if (bounds.empty()) return nullptr;
  return {{"lower", vector_json(bounds.lower)}, {"upper", vector_json(bounds.upper)}};
}

Json scene_json(const SceneDescription& scene, const SceneCounts& counts) {
  Json json = {{"file", scene.source},
               {"hash", scene.hash},
               {"counts", to_json(counts)},
               {"bounds", nullptr},
               {"render", nullptr}};
  json["cameras"] = list_json(scene.cameras, camera_json);
  json["punctual_lights"] = list_json(scene.lights, light_json);
  json["materials"] = list_json(scene.materials, material_json);
  json["features"] = features_json(scene.features);
  json["notices"] = to_json(scene.notices);
  return json;
}

}  // namespace vernier::apps
