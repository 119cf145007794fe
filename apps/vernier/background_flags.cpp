// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/background_flags.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "apps/vernier/flags.h"
#include "apps/vernier/memory_limit.h"
#include "core/base/quantities.h"
#include "integrators/render/backdrop.h"
#include "integrators/render/picture.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

/// None where the text is no colour.
std::optional<Rgb> as_color(const std::string& text) {
  try {
    const auto [r, g, b] = parse_color(text);
    return Rgb(r, g, b);
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// A word that is no file, or what looks like numbers, is more likely a misspelt colour.
void require_picture(const std::string& text) {
  std::error_code unknown;
  const bool is_number = text.find_first_not_of("0123456789.,+-eE#") == std::string::npos;
  if ((is_number || text.find_first_of("./") == std::string::npos) && !std::filesystem::exists(text, unknown))
    throw Error(ErrorKind::usage,
                fmt::format("--background: '{}' is no file and no colour; expected sRGB such as '#ff8000', "
                            "scene-linear such as 0.2,0.2,0.2, or a picture",
                            text));
  require_readable(text);
}

}  // namespace

std::string BackgroundFlags::file() const {
  return background.empty() || as_color(background) ? std::string() : background;
}

void add_background_flags(CLI::App& command, BackgroundFlags& flags) {
  command.add_flag("--transparent", flags.transparent,
                   "nothing behind the scene: .png and .exr get alpha, through clear glass too");
  command
      .add_option(
          "--background", flags.background,
          "what the camera sees behind the scene, which does not light it: sRGB '#rrggbb', scene-linear "
          "R,G,B, or a picture that fills the frame")
      ->type_name("COLOUR|FILE");
  command
      .add_option(
          "--ground", flags.ground,
          "under the scene: none; matte, a level grey plane that it stands on; shadow, its shadow alone on "
          "what --transparent or --background shows")
      ->check(CLI::IsMember({"none", "matte", "shadow"}))
      ->type_name("none|matte|shadow")
      ->capture_default_str();
}

std::shared_ptr<const Image> read_background_picture(const BackgroundFlags& flags, uint64_t max_memory) {
  const std::string file = flags.file();
  if (file.empty()) return nullptr;
  return std::make_shared<const Image>(read_background(file, limits_within(max_memory)));
}

std::optional<GroundKind> choose_ground(const BackgroundFlags& flags, const std::string& integrator) {
  if (flags.ground == "none") return std::nullopt;
  if (flags.ground == "matte") return GroundKind::matte;
  if (!flags.transparent && flags.background.empty())
    throw Error(ErrorKind::usage, {}, "--ground shadow",
                "falls on what is behind the scene; add --transparent or --background");
  if (integrator != "path") throw Error(ErrorKind::usage, {}, "--ground shadow", "needs --integrator path");
  return GroundKind::shadow;
}

Background choose_background(const BackgroundFlags& flags, const std::vector<std::string>& outputs) {
  Background background;
  if (flags.transparent) {
    if (!flags.background.empty())
      throw Error(ErrorKind::usage, "--transparent has nothing behind the scene; drop it or --background");
    for (const auto& path : outputs) require_alpha_fits(path);
    background.kind = Background::Kind::transparent;
  } else if (const std::string file = flags.file(); !file.empty()) {
    require_picture(file);
    background.kind = Background::Kind::picture;
    background.file = file;
  } else if (!flags.background.empty()) {
    background.kind = Background::Kind::color;
    background.color = *as_color(flags.background);
  }
  return background;
}

}  // namespace vernier::apps
