// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/view_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/vernier/messages.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Vec3f& v) { return {v.x, v.y, v.z}; }

/// The point that the camera goes around: where it looks, as far away as the middle of the subject.
Vec3f pivot(const CameraDescription& camera, const CameraFlags& flags, const Bounds& subject) {
  const Vec3f& from = camera.to_world.origin;
  const Vec3f ahead = -normalize(camera.to_world.z);
  if (!flags.look_at.empty()) {
    const auto [x, y, z] = parse_point(flags.look_at);
    return {x, y, z};
  }
  const float distance = dot(subject.center() - from, ahead);
  return from + ahead * (distance > 0 ? distance : std::max(subject.radius(), 1e-3f));
}

/// The world's up, unless the camera is rolled.
Vec3f up_of(const CameraDescription& camera) {
  const Vec3f back = normalize(camera.to_world.z), world(0, 1, 0);
  const Vec3f level = world - back * dot(world, back);
  const Vec3f own = normalize(camera.to_world.y);
  constexpr float hardly_rolled = 1e-4f;
  const bool is_level = length(level) > 1e-3f && length(normalize(level) - own) < hardly_rolled;
  return is_level ? world : own;
}

Json camera_json(const CameraDescription& camera, const CameraFlags& flags, const LiveScene& scene) {
  const bool is_flat = camera.kind == CameraDescription::Kind::orthographic;
  Json json{{"name", camera.name},
            {"from", to_json(camera.to_world.origin)},
            {"at", to_json(pivot(camera, flags, scene.subject_bounds()))},
            {"up", to_json(up_of(camera))},
            {"orthographic", is_flat}};
  if (is_flat)
    json["height"] = 2 * camera.ymag;
  else
    json["fov"] = camera.yfov * 180 / pi;
  if (camera.lens_radius > 0) json["focus"] = camera.focus_distance;
  return json;
}

Json notes_json(const NoticeLog& log) {
  std::set<std::string> said;
  Json notes = Json::array();
  for (const Notice& notice : log.notices())
    if (const std::string text = describe(notice); said.insert(text).second) notes.push_back(text);
  return notes;
}

Json values_at(const Image& image, int x, int y) { return to_json(Vec3f(rgb_at(image, x, y))); }

}  // namespace

Json facts_json(const LiveScene& scene, const ViewFlags& flags, const std::string& file) {
  Json choices = Json::object();
  for (const auto& [flag, names] : flags.choices()) choices[flag] = names;
  Json animations = Json::array();
  for (const AnimationSpan& animation : scene.file().animations())
    animations.push_back({{"name", animation.name}, {"seconds", animation.seconds}});
  return {{"file", file},
          {"choices", choices},
          {"animations", animations},
          {"radius", scene.subject_bounds().radius()}};
}

Json view_json(uint64_t number, const std::string& command, const RenderRequest& request,
               const RenderSettings& settings, const LiveScene& scene, const NoticeLog& log) {
  const RenderFlags& flags = request.flags;
  return {{"view", number},
          {"command", command},
          {"width", settings.width},
          {"height", settings.height},
          {"camera", camera_json(settings.camera, flags.camera, scene)},
          {"surroundings", scene.surroundings()},
          {"notes", notes_json(log)},
          {"values",
           {{"--camera", flags.camera.camera},
            {"--exposure", request.display.exposure},
            {"--view", request.display.view},
            {"--env", flags.surroundings.environment},
            {"--env-rotate", flags.surroundings.rotate},
            {"--fog", flags.fog},
            {"--variant", flags.import.variant},
            {"--animation", flags.import.animation},
            {"--at", flags.import.time ? Json(*flags.import.time) : Json()},
            {"--integrator", flags.integrator},
            {"--caustics", flags.caustics},
            {"--show", settings.integrator_options.show},
            {"--denoise", flags.denoise},
            {"--fstop", flags.camera.lens.fstop ? Json(*flags.camera.lens.fstop) : Json()},
            {"--spp", settings.limits.spp},
            {"--error", settings.limits.error},
            {"--size", flags.size}}}};
}

Json pixel_json(int x, int y, const Frame& frame, const LiveScene& scene) {
  Json json{{"x", x}, {"y", y}, {"frame", frame.number}};
  const int i = std::min(x / frame.step, frame.color.width - 1);
  const int j = std::min(y / frame.step, frame.color.height - 1);
  json["value"] = values_at(frame.color, i, j);
  json["error"] = frame.error ? values_at(*frame.error, i, j) : Json();
  if (const auto thing = scene.look_at(x, y)) {
    json["object"] = thing->object;
    json["material"] = thing->material;
    json["distance"] = thing->distance;
    json["position"] = to_json(thing->position);
  }
  return json;
}

}  // namespace vernier::apps
