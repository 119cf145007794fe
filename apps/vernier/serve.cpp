// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <future>
#include <nlohmann/json.hpp>

#include "apps/serve/http_server.h"
#include "apps/serve/view_json.h"
#include "apps/vernier/choose_camera.h"
#include "apps/vernier/commands.h"
#include "apps/vernier/display_flags.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/stop_signals.h"
#include "core/base/parallel.h"
#include "core/denoise/denoise.h"
#include "scene/lights/built_in_environment.h"

namespace vernier::apps {
namespace {

constexpr int default_longer_side = 640;
constexpr int64_t most_pixels = 1920 * 1080;  // that a page may ask for, if not the command

struct ServeFlags {
  RenderFlags render;
  std::string host = "127.0.0.1";
  int port = 8080;
};

template <typename Table>
std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& entry : table) names.emplace_back(entry.name);
  return names;
}

std::vector<std::string> optional(std::vector<std::string> names) {
  names.insert(names.begin(), "");
  return names;
}

FlagChoices choices(const RenderFlags& flags, const LiveScene& scene) {
  std::vector<std::string> surroundings{"", "none"};
  for (const auto& built_in : built_in_environments()) surroundings.push_back(built_in.name);
  const std::string& own = flags.surroundings.environment;
  if (std::find(surroundings.begin(), surroundings.end(), own) == surroundings.end())
    surroundings.push_back(own);
  std::vector<std::string> filters{"", "auto"};
  for (const Denoiser& denoiser : denoisers()) filters.emplace_back(denoiser.name);
  std::vector<std::string> animations{""};
  const size_t count = scene.file().animations().size();
  for (size_t i = 0; i < count; ++i) animations.push_back(std::to_string(i));
  return {{"--camera", scene.camera_names()},
          {"--view", display_views(flags.display)},
          {"--env", std::move(surroundings)},
          {"--variant", optional(scene.file().variants())},
          {"--animation", std::move(animations)},
          {"--integrator", names_of(integrators())},
          {"--caustics", {"auto", "on", "off"}},
          {"--show", {raycast_outputs().begin(), raycast_outputs().end()}},
          {"--denoise", std::move(filters)}};
}

/// What a page shows at first where the command does not say it: a picture of moderate size and effort.
FlagValues first_values(const RenderFlags& flags, const RenderSettings& settings) {
  FlagValues values;
  if (!flags.spp && flags.time.empty() && flags.error.empty()) values["--spp"] = "256";
  const bool has_pixel = flags.camera.lens.focus.find(',') != std::string::npos;
  if (flags.size.empty() && !has_pixel) {
    const double part = double(default_longer_side) / std::max(settings.width, settings.height);
    values["--size"] = fmt::format("{}x{}", std::max(1L, std::lround(settings.width * part)),
                                   std::max(1L, std::lround(settings.height * part)));
  }
  return values;
}

bool print_requested_list_of(const ServeFlags& flags) {
  return print_requested_list(flags.render) || print_requested_views(flags.render.display);
}

/// Serves until a signal asks for the end.
void serve_until_stopped(HttpServer& server, const Served& served) {
  using namespace std::chrono_literals;
  const StopSignals signals;
  auto answering = std::async(std::launch::async, [&] { server.serve(served); });
  while (answering.wait_for(50ms) == std::future_status::timeout)
    if (signals.stop()) {
      served.audience.close();
      server.stop();
    }
  answering.get();
}

ExitCode run_serve(const ServeFlags& flags, const CLI::App& command) {
  if (print_requested_list_of(flags)) return ExitCode::done;
  const std::string file = flags.render.run.scenes.empty() ? "" : flags.render.run.scenes.front();
  require_scene(file, "serve");
  if (flags.render.camera.panorama)
    throw Error(ErrorKind::usage,
                "--panorama: there is nothing to turn in a picture of all around; leave it out");
  const ThreadLimit threads(flags.render.threads);
  auto background = read_background_picture(flags.render.background, flags.render.import.memory.bytes);
  HttpServer server(flags.host, flags.port);

  LiveScene scene(file, flags.render.import, std::move(background));
  const PictureCommand picture(command);
  NoticeLog log(flags.render.quiet);
  const ViewFlags as_given(picture, file, {}, most_pixels);
  const RenderSettings settings = scene.prepare(as_given.request({}), log);
  const int64_t pixels = int64_t(settings.width) * settings.height;
  const ViewFlags view_flags(picture, file, choices(flags.render, scene), std::max(most_pixels, pixels));
  Audience audience(HttpServer::most_pages);
  LiveRender render(scene, view_flags, audience, first_values(flags.render, settings));
  fmt::print("serving {} at {}\n", one_line(file), server.address());
  std::fflush(stdout);
  serve_until_stopped(server, {render, scene, audience, facts_json(scene, view_flags, file).dump()});
  return ExitCode::done;
}

}  // namespace

void register_serve(Program& program) {
  CLI::App* command = program.app.add_subcommand("serve", "Show a scene in a browser, rendered live");
  auto flags = std::make_shared<ServeFlags>();
  RenderFlags& render = flags->render;
  command->add_option("SCENE", render.run.scenes, "glTF 2.0 scene (.gltf, .glb)")
      ->type_name("")
      ->expected(0, 1);
  command->add_option("--port", flags->port, "port of the address; 0: any that is free")
      ->transform(whole_number(0, 65535))
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option(
          "--host", flags->host,
          "address of the network interface; 0.0.0.0: all. Any but this machine's own needs the token "
          "that is then printed")
      ->type_name("ADDRESS")
      ->capture_default_str();
  add_import_flags(*command, render.import);
  add_picture_flags(*command, render);
  command->option_defaults()->group("Output");
  add_denoise_flag(*command, render);
  add_display_flags(*command, render.display);
  command->add_flag("-q,--quiet", render.quiet, "say nothing but the address and errors");
  command->footer("Example: vernier serve scene.glb --env studio");
  command->callback(
      [&program, flags, command] { program.run = [flags, command] { return run_serve(*flags, *command); }; });
}

}  // namespace vernier::apps
