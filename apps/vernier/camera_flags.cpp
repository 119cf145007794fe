// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/camera_flags.h"

#include <fmt/format.h>

#include <charconv>

#include "apps/vernier/flags.h"
#include "core/base/quantities.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

/// Flags that both say the same thing of the camera.
struct Conflict {
  const char *a, *b, *reason;
};
constexpr Conflict conflicts[] = {
    {"--look-from", "--camera", "each says where the camera stands"},
    {"--look-from", "--azimuth", "each says where the camera stands"},
    {"--look-from", "--elevation", "each says where the camera stands"},
    {"--look-from", "--fit", "--fit moves the camera; --zoom does not"},
    {"--camera", "--azimuth", "each says where the camera stands"},
    {"--camera", "--elevation", "each says where the camera stands"},
    {"--camera", "--fit", "--fit moves the camera; --zoom does not"},
    {"--ortho", "--fov", "an orthographic camera has no angle; --ortho HEIGHT says how much it sees"},
    {"--ortho", "--fstop", "an orthographic camera sees everything sharp"},
    {"--panorama", "--fov", "a panorama sees all around"},
    {"--panorama", "--zoom", "a panorama sees all around"},
    {"--panorama", "--ortho", "a panorama sees all around from one point"},
    {"--panorama", "--fstop", "a panorama sees everything sharp"},
    {"--panorama", "--look-at", "a panorama sees all around; +x is in its middle, as in --env pictures"},
    {"--panorama", "--up", "+y is up in a panorama, as in --env pictures"},
    {"--panorama", "--roll", "+y is up in a panorama, as in --env pictures"},
};

void refuse_contradictions(const CLI::App& command) {
  for (const auto& [a, b, reason] : conflicts)
    if (command.count(a) > 0 && command.count(b) > 0)
      throw CLI::ValidationError(fmt::format("{} and {} contradict each other: {}", a, b, reason));
  for (const char* flag : {"--look-at", "--up"})
    if (command.count(flag) > 0 && command.count("--look-from") == 0)
      throw CLI::ValidationError(fmt::format(
          "{} needs --look-from; --azimuth and --elevation go around the scene without it", flag));
  for (const char* flag : {"--focus", "--sensor"})
    if (command.count(flag) > 0 && command.count("--fstop") == 0)
      throw CLI::ValidationError(fmt::format("{} needs --fstop N; without a lens everything is sharp", flag));
}

/// What follows --ortho may be its height, or belong to something else, which the parser cannot know.
std::string check_height(const std::string& text) {
  float height = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), height);
  if (error == std::errc{} && end == text.data() + text.size() && height > 0 && height < 1e30f) return {};
  return fmt::format("'{}' is not a height in metres; without one, put --ortho last or before another flag",
                     text);
}

void add_angle(CLI::App& command, const char* flag, std::optional<float>& angle, const char* text) {
  command.add_option(flag, angle, text)->check(real_number(-1e6, 1e6))->type_name("DEG");
}

}  // namespace

void add_camera_flags(CLI::App& command, CameraFlags& flags) {
  const std::string group = command.option_defaults()->get_group();
  command.option_defaults()->group("Camera");
  command.add_option("--camera", flags.camera, "camera of the scene, by name or number, or all (the first)")
      ->type_name("NAME|N|all");
  add_angle(command, "--azimuth", flags.azimuth,
            "see the whole scene from this far to the right of its front (30)");
  add_angle(command, "--elevation", flags.elevation, "and from this far above (15)");
  command
      .add_option("--fit", flags.fit,
                  "see the whole scene, with this part of the picture free around it (8%)")
      ->check(parsed_by(parse_margin))
      ->type_name("MARGIN");
  command.add_option("--look-from", flags.look_from, "place of the camera, metres")
      ->check(parsed_by(parse_point))
      ->type_name("X,Y,Z");
  command.add_option("--look-at", flags.look_at, "what it looks at (the scene's centre)")
      ->check(parsed_by(parse_point))
      ->type_name("X,Y,Z");
  command.add_option("--up", flags.up, "what is up in its picture (0,1,0)")
      ->check(parsed_by(parse_point))
      ->type_name("X,Y,Z");
  command.add_option("--roll", flags.roll, "turn any camera clockwise about the way it looks")
      ->check(real_number(-1e6, 1e6))
      ->type_name("DEG");
  command.add_option("--fov", flags.fov, "vertical angle that the camera sees")
      ->check(real_number(0.01, 179))
      ->type_name("DEG");
  command.add_option("--zoom", flags.zoom, "show things this many times as large")
      ->check(real_number(1e-6, 1e6))
      ->type_name("F");
  command
      .add_option_function<std::vector<std::string>>(
          "--ortho",
          [&flags](const std::vector<std::string>& values) {
            flags.ortho = true;
            if (!values.empty() && !values.front().empty()) flags.ortho_height = std::stof(values.front());
          },
          "look without perspective, at so many metres from bottom to top (as many as fit)")
      ->expected(0, 1)
      ->check(CLI::Validator([](std::string& text) { return text.empty() ? text : check_height(text); }, ""))
      ->type_name("HEIGHT");
  command.add_flag("--panorama", flags.panorama,
                   "see all around, as a picture that --env takes: twice as wide as high");
  add_lens_flags(command, flags.lens);
  command.parse_complete_callback([&command] { refuse_contradictions(command); });
  command.option_defaults()->group(group);
}

}  // namespace vernier::apps
