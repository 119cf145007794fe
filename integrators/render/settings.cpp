// SPDX-License-Identifier: Apache-2.0
#include "vernier/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/fingerprint.h"
#include "core/base/names.h"
#include "integrators/render/pixel_filter.h"
#include "integrators/render/settings_identity.h"
#include "integrators/render/texture_filter.h"

namespace vernier {
namespace {

using Json = nlohmann::ordered_json;

constexpr int format_version = 2;

constexpr std::array<std::pair<std::string_view, LightSampling>, 3> light_samplings{
    {{"mis", LightSampling::mis}, {"light", LightSampling::light}, {"bsdf", LightSampling::bsdf}}};

constexpr std::array<std::pair<std::string_view, Caustics>, 3> caustics_names{
    {{"auto", Caustics::automatic}, {"on", Caustics::on}, {"off", Caustics::off}}};

using CameraKind = CameraDescription::Kind;
constexpr std::array<std::pair<std::string_view, CameraKind>, 3> camera_kinds{
    {{"perspective", CameraKind::perspective},
     {"orthographic", CameraKind::orthographic},
     {"panorama", CameraKind::panorama}}};
constexpr std::array<std::pair<std::string_view, Background::Kind>, 4> background_kinds{
    {{"surroundings", Background::Kind::surroundings},
     {"transparent", Background::Kind::transparent},
     {"color", Background::Kind::color},
     {"picture", Background::Kind::picture}}};

/// Calls visit(name, values...) for all that samples depend on. What is not listed here is in no settings
/// file, and a checkpoint would go on without noticing that it has changed.
template <typename Settings, typename Visit>
void for_each_setting(Settings& s, const Visit& visit) {
  auto& options = s.integrator_options;
  visit("camera", s.camera);
  visit("background", s.background);
  visit("size", s.width, s.height);
  visit("crop", s.crop);
  visit("filter", s.filter);
  visit("texture-filter", s.texture_filter);
  visit("integrator", s.integrator);
  visit("max-depth", options.max_depth);
  visit("light-sampling", options.light_sampling);
  visit("roulette", options.russian_roulette);
  visit("caustics", options.caustics);
  visit("show", options.show);
  visit("ambient", options.ambient);
  visit("cutoff", options.cutoff);
  visit("light-split", s.light_split);
  visit("row-exposure", s.row_exposure);
  visit("adaptive", s.adaptive);
  visit("seed", s.seed);
}

Json encode(const Vec3f& v) { return {v.x, v.y, v.z}; }
/// The name of a value, null where it has none.
template <typename Names, typename Value>
Json name_of(const Names& names, Value value) {
  for (const auto& [name, named] : names)
    if (named == value) return std::string(name);
  return nullptr;
}
Json encode(LightSampling value) { return name_of(light_samplings, value); }
Json encode(Caustics value) { return name_of(caustics_names, value); }
Json encode(const PixelFilter& filter) { return filter_text(filter); }
Json encode(const TextureFilter& filter) { return texture_filter_text(filter); }
Json encode(const Crop& crop) {
  return crop.width > 0 ? Json{crop.x, crop.y, crop.width, crop.height} : Json(nullptr);
}
Json encode(const Transform& t) { return {encode(t.x), encode(t.y), encode(t.z), encode(t.origin)}; }
Json encode(const CameraDescription& camera) {
  Json json = {
      {"name", camera.name},
      {"kind", name_of(camera_kinds, camera.kind)},
      {"yfov", camera.yfov},
      {"aspect", camera.aspect},
      {"xmag", camera.xmag},
      {"ymag", camera.ymag},
      {"lens_radius", camera.lens_radius},
      {"focus_distance", std::isinf(camera.focus_distance) ? Json(nullptr) : Json(camera.focus_distance)},
      {"to_world", encode(camera.to_world)}};
  for (const Transform& moment : camera.moments) json["moments"].push_back(encode(moment));
  return json;
}
Json encode(const Background& background) {
  return {{"kind", name_of(background_kinds, background.kind)},
          {"color", encode(background.color)},
          {"file", background.file}};
}
Json encode(const LightSplit& split) {
  Json json{{"ways", split.ways}, {"groups", Json::array()}};
  for (const LightGroup& group : split.groups)
    json["groups"].push_back({{"name", group.name}, {"lights", group.lights}});
  return json;
}
template <typename T>
Json encode(const T& value) {
  return value;
}

void decode(const Json& json, Vec3f& v) {
  for (int i = 0; i < 3; ++i) v[i] = json.at(size_t(i)).get<float>();
}
template <typename Names, typename Value>
void decode_name(const Json& json, const char* kind, const Names& names, Value& value) {
  std::vector<std::string> known;
  for (const auto& [name, named] : names) {
    known.emplace_back(name);
    if (json.get<std::string>() == name) value = named;
  }
  if (name_of(names, value) != json) throw_unknown_name(kind, json.get<std::string>(), known);
}
void decode(const Json& json, LightSampling& value) {
  decode_name(json, "light-sampling", light_samplings, value);
}
void decode(const Json& json, Caustics& value) { decode_name(json, "caustics", caustics_names, value); }
void decode(const Json& json, PixelFilter& filter) { filter = parse_filter(json.get<std::string>()); }
void decode(const Json& json, TextureFilter& filter) {
  filter = parse_texture_filter(json.get<std::string>());
}
void decode(const Json& json, Crop& crop) {
  crop = {};
  if (json.is_null()) return;
  crop = {json.at(0).get<int>(), json.at(1).get<int>(), json.at(2).get<int>(), json.at(3).get<int>()};
}
void decode(const Json& json, Transform& t) {
  size_t i = 0;
  for (Vec3f* column : {&t.x, &t.y, &t.z, &t.origin}) decode(json.at(i++), *column);
}
void decode(const Json& json, CameraDescription& camera) {
  camera = {};
  camera.name = json.at("name").get<std::string>();
  decode_name(json.at("kind"), "camera kind", camera_kinds, camera.kind);
  camera.yfov = json.at("yfov").get<float>();
  camera.aspect = json.at("aspect").get<float>();
  camera.xmag = json.at("xmag").get<float>();
  camera.ymag = json.at("ymag").get<float>();
  camera.lens_radius = json.at("lens_radius").get<float>();
  const Json& focus = json.at("focus_distance");
  camera.focus_distance = focus.is_null() ? std::numeric_limits<float>::infinity() : focus.get<float>();
  decode(json.at("to_world"), camera.to_world);
  if (!json.contains("moments")) return;
  for (const Json& moment : json.at("moments")) decode(moment, camera.moments.emplace_back());
}
void decode(const Json& json, Background& background) {
  decode_name(json.at("kind"), "background", background_kinds, background.kind);
  decode(json.at("color"), background.color);
  background.file = json.at("file").get<std::string>();
}
void decode(const Json& json, LightSplit& split) {
  split = {json.at("ways").get<std::vector<std::string>>(), {}};
  for (const Json& group : json.at("groups"))
    split.groups.push_back(
        {group.at("name").get<std::string>(), group.at("lights").get<std::vector<std::string>>()});
}
template <typename T>
void decode(const Json& json, T& value) {
  value = json.get<T>();
}

/// For people to read.
std::string text(bool value) { return value ? "on" : "off"; }
std::string text(const std::string& value) { return value; }
std::string text(const PixelFilter& filter) { return filter_text(filter); }
std::string text(const TextureFilter& filter) { return texture_filter_text(filter); }
std::string text(LightSampling value) { return encode(value).get<std::string>(); }
std::string text(Caustics value) { return encode(value).get<std::string>(); }
std::string text(const CameraDescription& camera) {
  Json json = encode(camera);
  json.erase("name");
  const std::string numbers = json.dump();
  return fmt::format("{} ({:.8})", camera.name, fingerprint(std::as_bytes(std::span(numbers))));
}
template <typename T>
std::string text(const T& value) {
  return fmt::format("{}", value);
}
std::string text(const LightSplit& split) {
  std::string all = fmt::format("{}", fmt::join(split.ways, " "));
  for (const LightGroup& group : split.groups)
    all += fmt::format("{}{}={}", all.empty() ? "" : " ", group.name, fmt::join(group.lights, "+"));
  return all.empty() ? "none" : all;
}
std::string text(const Background& background) { return background_text(background); }
std::string text(const Crop& crop) { return crop.width > 0 ? crop_text(crop) : "none"; }

}  // namespace

std::string background_text(const Background& background) {
  const Rgb& color = background.color;
  switch (background.kind) {
    case Background::Kind::surroundings:
      return "surroundings";
    case Background::Kind::transparent:
      return "transparent";
    case Background::Kind::color:
      return fmt::format("{:g},{:g},{:g}", color.x, color.y, color.z);
    case Background::Kind::picture:
      return background.file;
  }
  return "";
}

Caustics parse_caustics(std::string_view name) {
  Caustics value{};
  decode(Json(name), value);
  return value;
}

std::string crop_text(const Crop& crop) {
  return fmt::format("{}x{}+{}+{}", crop.width, crop.height, crop.x, crop.y);
}

RenderIdentity identity_of(const RenderSettings& settings) {
  RenderIdentity identity;
  for_each_setting(settings, [&](const char* name, const auto&... values) {
    const std::string all = fmt::format("{}", fmt::join(std::array{text(values)...}, "x"));
    if (all != "none") identity.emplace_back(name, all);
  });
  return identity;
}

std::string RenderSettings::to_json() const {
  Json json{{"vernier_settings", format_version}};
  for_each_setting(*this, [&](const char* name, const auto&... values) {
    if constexpr (sizeof...(values) == 1)
      json[name] = encode(values...);
    else
      json[name] = {encode(values)...};
  });
  const bool timed = std::isfinite(limits.seconds);
  json["limits"] = {{"spp", limits.spp},
                    {"seconds", timed ? Json(limits.seconds) : Json(nullptr)},
                    {"error", limits.error}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

RenderSettings RenderSettings::from_json(std::string_view json_text) {
  const auto refuse = [](const std::string& problem) {
    throw Error(ErrorKind::input, "settings", {}, problem);
  };
  RenderSettings settings;
  try {
    const Json json = Json::parse(json_text);
    const int version = json.at("vernier_settings").get<int>();
    if (version != format_version)
      refuse(
          fmt::format("are of format {}; this version of Vernier reads format {}", version, format_version));
    for_each_setting(settings, [&](const char* name, auto&... values) {
      const Json& value = json.at(name);
      if constexpr (sizeof...(values) == 1) {
        decode(value, values...);
      } else {
        size_t i = 0;
        (decode(value.at(i++), values), ...);
      }
    });
    const Json& limits = json.at("limits");
    settings.limits.spp = limits.at("spp").get<int>();
    if (!limits.at("seconds").is_null()) settings.limits.seconds = limits.at("seconds").get<double>();
    settings.limits.error = limits.at("error").get<double>();
  } catch (const Json::exception& error) {
    refuse(fmt::format("cannot be read: {}", error.what()));
  }
  return settings;
}

}  // namespace vernier
