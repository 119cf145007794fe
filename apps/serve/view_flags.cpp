// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/view_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/names.h"
#include "core/base/quantities.h"

namespace vernier::apps {
namespace {

constexpr size_t longest_value = 200;

/// Flags that say where a camera is and how much it sees. A page that moves the camera replaces all of them.
const std::set<std::string> camera_flags{"--camera",    "--azimuth", "--elevation", "--fit",
                                         "--look-from", "--look-at", "--up",        "--roll",
                                         "--zoom",      "--fov",     "--ortho"};

/// Flags that take numbers, of which the parser of `vernier render` knows the bounds.
const std::set<std::string> number_flags{
    "--look-from",  "--look-at",   "--up",  "--fov", "--ortho", "--fstop", "--focus", "--exposure",
    "--env-rotate", "--env-scale", "--fog", "--at",  "--size",  "--spp",   "--error"};

/// Flags that mean nothing, or are refused, unless another one is given.
struct Dependent {
  const char *flag, *needs;
};
constexpr Dependent dependents[] = {
    {"--focus", "--fstop"}, {"--sensor", "--fstop"}, {"--env-rotate", "--env"}, {"--env-scale", "--env"}};

[[noreturn]] void refuse(const std::string& problem) { throw Error(ErrorKind::usage, problem); }

/// Whether all of `text` may be part of numbers, "1.5,-2e3,0", "640x360" or "auto".
bool is_number_like(const std::string& text) {
  return text == "auto" || text.find_first_not_of("0123456789.,+-eEx%") == std::string::npos;
}

void blank_camera(FlagValues& values) {
  for (const std::string& flag : camera_flags) values[flag] = "";
}

}  // namespace

ViewFlags::ViewFlags(PictureCommand command, std::string scene, FlagChoices choices, int64_t most_pixels)
    : command_(std::move(command)),
      scene_(std::move(scene)),
      choices_(std::move(choices)),
      most_pixels_(most_pixels) {}

void ViewFlags::set_camera(FlagValues& values, const std::string& choice) const {
  for (const std::string& flag : camera_flags) values.erase(flag);
  if (choice == "start") return;
  blank_camera(values);
  if (choice == "fitted") {
    values["--fit"] = "8%";
    return;
  }
  const auto& cameras = choices_.at("--camera");
  if (std::find(cameras.begin(), cameras.end(), choice) == cameras.end())
    throw_unknown_name("camera", choice, cameras);
  values["--camera"] = choice;
}

void ViewFlags::set_flag(FlagValues& values, const std::string& flag, const std::string& value) const {
  if (const auto choices = choices_.find(flag); choices != choices_.end() && !camera_flags.contains(flag)) {
    const auto& names = choices->second;
    if (std::find(names.begin(), names.end(), value) == names.end()) throw_unknown_name(flag, value, names);
  } else if (!number_flags.contains(flag)) {
    refuse(fmt::format("'{}' is no flag that a page may set", flag));
  } else if (!is_number_like(value)) {
    refuse(fmt::format("{}: '{}' is no number", flag, value));
  }
  if (flag == "--size") {
    const PixelSize size = parse_pixel_size(value);
    if (int64_t(size.width) * size.height > most_pixels_)
      refuse(fmt::format("--size {}: a page may ask for {} pixels at most", value, most_pixels_));
  }
  values[flag] = value;
}

std::string ViewFlags::value_of(const FlagValues& values, const std::string& flag) const {
  const auto own = values.find(flag);
  return own != values.end() ? own->second : command_.value(flag);
}

void ViewFlags::leave_out_dependents(FlagValues& values) const {
  for (const auto& [flag, needs] : dependents) {
    const std::string needed = value_of(values, needs);
    if (needed.empty() || needed == "none") values[flag] = "";
  }
  if (value_of(values, "--integrator") != "raycast") values["--show"] = "";
}

FlagValues ViewFlags::changed(const FlagValues& now, const nlohmann::json& change) const {
  if (!change.is_object()) refuse("expected an object of flags and their values");
  FlagValues values = now;
  if (change.contains("--look-from")) blank_camera(values);
  for (const auto& [flag, json] : change.items()) {
    if (!json.is_string()) refuse(fmt::format("the value of '{}' must be a text", flag));
    const auto& value = json.get_ref<const std::string&>();
    if (value.size() > longest_value) refuse(fmt::format("the value of '{}' is too long", flag));
    if (flag == "camera")
      set_camera(values, value);
    else
      set_flag(values, flag, value);
  }
  leave_out_dependents(values);
  request(values);  // or it throws
  return values;
}

std::string ViewFlags::command(const FlagValues& values) const {
  return command_.text(scene_, values) + " -o picture.png";
}

RenderRequest ViewFlags::request(const FlagValues& values) const {
  std::vector<std::string> words = command_.words(scene_, values);
  words.erase(words.begin(), words.begin() + 2);  // "vernier render"
  words.insert(words.end(), {"-o", "picture.png"});
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  CLI::App app;
  RenderFlags flags;
  add_render_flags(app, flags);
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    refuse(error.what());
  }
  const SurroundingsFlags surroundings = std::exchange(flags.surroundings, {});
  RenderRequest request = check_render_flags(flags);
  request.flags.surroundings = surroundings;
  return request;
}

}  // namespace vernier::apps
