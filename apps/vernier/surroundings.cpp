// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/surroundings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/vernier/flags.h"
#include "apps/vernier/memory_limit.h"
#include "core/base/names.h"
#include "core/image/image_io.h"
#include "integrators/render/visible_light.h"
#include "scene/camera.h"
#include "scene/lights/built_in_environment.h"
#include "scene/scene.h"
#include "vernier/error.h"
#include "vernier/session.h"

namespace vernier::apps {
namespace {

constexpr std::string_view nothing = "none", own = "scene", default_surroundings = "studio";

std::vector<std::string> names_without_file() {
  std::vector<std::string> names{std::string(nothing)};
  for (const auto& built_in : built_in_environments()) names.push_back(built_in.name);
  return names;
}

Surroundings built_in(const BuiltInEnvironment& entry) {
  auto environment = std::make_shared<EnvironmentDescription>();
  environment->picture = entry.picture();
  return {entry.name, std::move(environment), entry.turns_with_camera};
}

bool is_built_in(const std::string& name) {
  const auto& all = built_in_environments();
  return std::any_of(all.begin(), all.end(), [&](const auto& entry) { return entry.name == name; });
}

/// A word that is neither a name nor a file is more likely a misspelt name.
void require_picture(const std::string& file) {
  std::error_code unknown;
  if (file.find_first_of("./") == std::string::npos && !std::filesystem::exists(file, unknown)) {
    const auto names = names_without_file();
    const auto nearest = nearest_name(file, names);
    throw Error(ErrorKind::usage,
                fmt::format("--env: '{}' is no file and none of {}{}", file, fmt::join(names, ", "),
                            nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
  }
  require_readable(file);
}

/// Surroundings that turn with a camera, where its look takes them.
std::shared_ptr<const EnvironmentDescription> turned(const Surroundings& surroundings,
                                                     const CameraDescription& view) {
  if (!surroundings.environment || !surroundings.turns_with_camera) return surroundings.environment;
  auto environment = std::make_shared<EnvironmentDescription>(*surroundings.environment);
  environment->rotation = std::remainder(environment->rotation + heading(view), 2 * pi);
  return environment;
}

}  // namespace

void add_surroundings_flags(CLI::App& command, SurroundingsFlags& flags) {
  command
      .add_option("--env", flags.environment,
                  "surroundings: none, studio, sky, or a latitude-longitude picture (the scene's own; the "
                  "studio where it is dark)")
      ->type_name("NAME|FILE");
  command.add_option("--env-rotate", flags.rotate, "degrees counter-clockwise seen from above")
      ->check(real_number(-1e6, 1e6))
      ->type_name("DEG");
  command.add_option("--env-scale", flags.scale, "multiplies its radiance")
      ->check(real_number(0, 1e30))
      ->type_name("S");
}

std::shared_ptr<const Image> EnvironmentPictures::read(const std::string& file, uint64_t max_memory) {
  const std::scoped_lock lock(mutex_);
  std::weak_ptr<const Image>& kept = pictures_[file];
  std::shared_ptr<const Image> picture = kept.lock();
  if (!picture) kept = picture = std::make_shared<const Image>(read_image(file, limits_within(max_memory)));
  return picture;
}

void check_surroundings(const SurroundingsFlags& flags) {
  const bool changed = flags.rotate != 0 || flags.scale != 1;
  if (changed && (flags.environment.empty() || flags.environment == nothing))
    throw Error(ErrorKind::usage, "--env-rotate and --env-scale need --env studio, sky or FILE");
  if (!flags.environment.empty() && flags.environment != nothing && !is_built_in(flags.environment))
    require_picture(flags.environment);
}

std::optional<Surroundings> read_surroundings(const SurroundingsFlags& flags) {
  EnvironmentPictures pictures;
  return read_surroundings(flags, pictures);
}

std::optional<Surroundings> read_surroundings(const SurroundingsFlags& flags, EnvironmentPictures& pictures) {
  check_surroundings(flags);
  if (flags.environment.empty()) return std::nullopt;
  if (flags.environment == nothing) return Surroundings{flags.environment, nullptr};
  for (const auto& entry : built_in_environments())
    if (entry.name == flags.environment) return turned_and_scaled(built_in(entry), flags);
  auto environment = std::make_shared<EnvironmentDescription>();
  environment->picture = pictures.read(flags.environment, flags.max_memory);
  return turned_and_scaled({flags.environment, std::move(environment)}, flags);
}

Surroundings turned_and_scaled(const Surroundings& plain, const SurroundingsFlags& flags) {
  if (!plain.environment) return plain;
  auto environment = std::make_shared<EnvironmentDescription>(*plain.environment);
  environment->rotation = std::remainder(flags.rotate, 360.0f) * pi / 180;
  environment->scale = flags.scale;
  return {plain.name, std::move(environment), plain.turns_with_camera};
}

void replace_surroundings(SceneDescription& description, const std::optional<Surroundings>& asked,
                          NoticeLog& log) {
  if (!asked) return;
  if (description.environment)
    log.add({Notice::Severity::info, "", "--env is used instead of the file's own environment"});
  description.environment = nullptr;
}

Surroundings set_environment(Scene& scene, const std::optional<Surroundings>& asked,
                             const CameraDescription& view, const RenderSettings& options, NoticeLog& log) {
  if (asked) {
    if (const auto environment = turned(*asked, view)) scene.set_environment(environment);
    return *asked;
  }
  RenderSettings seen = options;
  seen.camera = view;
  if (!is_dark(scene, seen)) return {std::string(scene.has_environment() ? own : nothing), nullptr};
  const bool lightless = scene.lights().size() == 0;
  Surroundings studio{std::string(default_surroundings),
                      built_in_environment(std::string(default_surroundings), view)};
  scene.set_environment(studio.environment);
  log.add({Notice::Severity::info,
           {},
           fmt::format("{}; adding a studio around it, --env none leaves it as it is",
                       lightless ? "the scene has no light" : "the scene's own lights leave it dark")});
  return studio;
}

}  // namespace vernier::apps
