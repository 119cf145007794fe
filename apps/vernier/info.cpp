// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/vernier/choose_camera.h"
#include "apps/vernier/commands.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/memory_limit.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/notice_log.h"
#include "apps/vernier/scene_json.h"
#include "apps/vernier/scene_summary.h"
#include "apps/vernier/surroundings.h"
#include "core/base/quantities.h"
#include "integrators/render/pixel_filter.h"
#include "scene/import/features.h"
#include "scene/scene.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

struct InfoFlags {
  std::string scene;
  ImportOptions import;
  bool json = false;
  bool extensions = false;
};

/// "kind perspective, vertical_degrees 40": the entries of an object that differ from `defaults`.
std::string describe_object(const Json& object, const Json& defaults) {
  std::string text;
  for (const auto& [key, value] : object.items()) {
    if (key == "name" || value.is_null() || (defaults.contains(key) && defaults[key] == value)) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key,
                        value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text;
}

void print_list(const char* title, const Json& list, const Json& defaults = Json::object()) {
  if (list.empty()) return;
  fmt::print("{}\n", title);
  for (size_t i = 0; i < list.size(); ++i) {
    const auto name = list[i]["name"].get<std::string>();
    const std::string text = one_line(
        fmt::format("  {}{}{}: {}", i, name.empty() ? "" : " ", name, describe_object(list[i], defaults)));
    fmt::print("{}\n", text);
  }
}

void print_features(const Json& features) {
  for (const Json& feature : features) {
    const auto note = feature["note"].get<std::string>();
    fmt::print("  {}\n",
               one_line(fmt::format("{}: {}{}{}", feature["name"].get<std::string>(),
                                    feature["status"].get<std::string>(), note.empty() ? "" : ", ", note)));
  }
}

std::string bounds_text(const Bounds& bounds) {
  if (bounds.empty()) return "empty";
  const Vec3f size = bounds.upper - bounds.lower;
  return fmt::format("{:.6g} x {:.6g} x {:.6g} m, from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})",
                     size.x, size.y, size.z, bounds.lower.x, bounds.lower.y, bounds.lower.z, bounds.upper.x,
                     bounds.upper.y, bounds.upper.z);
}

std::string surroundings_text(const std::string& name) {
  if (name == "none") return "without surroundings";
  return name == "scene" ? "in the scene's own environment" : fmt::format("with surroundings {}", name);
}

void print_text(const Json& scene, const SceneCounts& counts, const Bounds& bounds) {
  fmt::print("{}\n", one_line(scene["file"].get<std::string>()));
  fmt::print("hash       {}\n", scene["hash"].get<std::string>());
  fmt::print("bounds     {}\n", bounds_text(bounds));
  fmt::print("meshes     {}, of {} triangles and {} vertices\n", counts.meshes, counts.triangles,
             counts.vertices);
  fmt::print("instances  {}, of {} triangles\n", counts.instances, counts.instanced_triangles);
  fmt::print("materials  {}\n", counts.materials);
  fmt::print("textures   {}, {}\n", counts.textures, texture_bytes_text(counts));
  fmt::print("lights     {} punctual, {} emissive triangles\n", counts.punctual_lights,
             counts.emissive_triangles);
  const Json& render = scene["render"];
  fmt::print("render     by camera {}, {}, filter {}\n", one_line(render["camera"].get<std::string>()),
             surroundings_text(render["surroundings"].get<std::string>()),
             render["filter"].get<std::string>());
  print_list("cameras", scene["cameras"]);
  print_list("punctual lights", scene["punctual_lights"]);
  print_list("materials", scene["materials"], material_json(MaterialDescription{}));
  if (!scene["features"].empty()) fmt::print("features used\n");
  print_features(scene["features"]);
}

void print_json(const Json& json) {
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

/// All extensions that are known, whatever a scene uses.
ExitCode list_extensions(bool as_json) {
  const Json extensions = features_json(known_extensions());
  as_json ? print_json(extensions) : print_features(extensions);
  return ExitCode::done;
}

/// The camera and the surroundings that `vernier render` takes when it is told nothing.
Json default_render_json(Scene& scene, std::span<const CameraDescription> cameras) {
  NoticeLog unsaid(true);
  const CameraFlags flags;
  const CameraDescription view =
      place_camera(choose_camera(cameras, flags, unsaid), flags, scene.geometry(), 0, unsaid);
  RenderSettings options;
  fill_in_size(options, view);
  return {{"camera", view.name},
          {"surroundings", set_environment(scene, std::nullopt, view, options, unsaid).name},
          {"filter", filter_text(options.filter)}};
}

ExitCode run_info(const InfoFlags& flags) {
  if (flags.extensions) return list_extensions(flags.json);
  require_scene(flags.scene, "info");
  SceneDescription description = import_scene(flags.scene, flags.import);
  const SceneCounts counts = count(description);
  Json json = scene_json(description, counts);
  const auto cameras = description.cameras;
  const auto notices = description.notices;
  check_scene_size(description, flags.import.memory);
  Scene scene(std::move(description), {});
  if (flags.import.strict) refuse_warnings(flags.scene, scene.notices());
  json["bounds"] = bounds_json(scene.bounds());
  json["render"] = default_render_json(scene, cameras);
  if (flags.json) {
    print_json(json);
    return ExitCode::done;
  }
  print_text(json, counts, scene.bounds());
  NoticeLog log(false);
  log.add(notices);
  log.add(scene.notices());
  for (const CameraDescription& camera : cameras)
    if (!camera.defect.empty()) log.add({Notice::Severity::warning, {}, camera.defect});
  return ExitCode::done;
}

}  // namespace

void register_info(Program& program) {
  CLI::App* command = program.app.add_subcommand("info", "Say what a scene holds and how it is honoured");
  auto flags = std::make_shared<InfoFlags>();
  add_scene_flags(*command, flags->scene, flags->import);
  command->add_flag("--json", flags->json, "as JSON on standard output");
  command->add_flag("--extensions", flags->extensions, "all glTF extensions that are known, without a scene");
  command->callback([&program, flags] { program.run = [flags] { return run_info(*flags); }; });
}

}  // namespace vernier::apps
