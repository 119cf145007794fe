// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/shutter_flags.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "apps/vernier/flags.h"
#include "core/base/names.h"

namespace vernier::apps {
namespace {

/// As Blender's rolling shutter has it unless told otherwise.
constexpr float default_row_exposure = 0.1f;

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Where the flag counts in frames, those are of one second.
Shutter parse_shutter(const std::string& text, double frame_seconds = 1) {
  const size_t comma = text.find(',');
  if (comma == std::string::npos) {
    const auto part = number(text);
    if (!part || !(*part > 0 && *part <= 1))
      throw Error(
          ErrorKind::usage,
          fmt::format("'{}' is no part of a frame; expected more than 0 and at most 1, as 0.5, or when "
                      "it opens and closes, in seconds about the frame's time, as -0.01,0.01",
                      text));
    return {-*part / 2 * frame_seconds, *part / 2 * frame_seconds};
  }
  const auto open = number(std::string_view(text).substr(0, comma));
  const auto close = number(std::string_view(text).substr(comma + 1));
  if (!open || !close)
    throw Error(
        ErrorKind::usage,
        fmt::format("'{}' are not two numbers; expected when the shutter opens and closes, in seconds "
                    "about the frame's time: -0.01,0.01",
                    text));
  if (!(*open < *close))
    throw Error(
        ErrorKind::usage,
        fmt::format("'{}' closes before it has opened; expected OPEN,CLOSE, the later one last", text));
  return {*open, *close};
}

float parse_shape(const std::string& text) {
  if (text == "box") return 1;
  constexpr std::string_view rolling = "rolling";
  if (text == rolling) return default_row_exposure;
  if (text.starts_with("rolling:")) {
    const auto part = number(std::string_view(text).substr(rolling.size() + 1));
    if (part && *part >= 0 && *part <= 1) return float(*part);
    throw Error(ErrorKind::usage,
                fmt::format("'{}' exposes no part of the shutter; expected rolling:0 to rolling:1", text));
  }
  static const std::array<std::string, 2> known{"box", "rolling"};
  throw_unknown_name("shutter shape", text, known);
}

}  // namespace

void add_shutter_flag(CLI::App& command, ShutterFlags& flags) {
  command
      .add_option(
          "--shutter", flags.shutter,
          "motion blur: open for this part of a frame, centered on it, or between two times about it, "
          "in seconds (docs/motion.md)")
      ->check(parsed_by([](const std::string& text) { return parse_shutter(text); }))
      ->type_name("PART|OPEN,CLOSE");
}

void add_shutter_shape_flag(CLI::App& command, ShutterFlags& flags) {
  command
      .add_option(
          "--shutter-shape", flags.shape,
          "box: all rows are exposed throughout; rolling: one after the other, each for a part (0.1) of "
          "the time")
      ->check(parsed_by(parse_shape))
      ->type_name("box|rolling[:PART]");
}

std::optional<Shutter> shutter_of(const ShutterFlags& flags, double frame_seconds) {
  if (flags.shutter.empty()) return std::nullopt;
  return parse_shutter(flags.shutter, frame_seconds);
}

float row_exposure_of(const ShutterFlags& flags) {
  if (flags.shape.empty()) return 1;
  if (flags.shutter.empty()) throw Error(ErrorKind::usage, "--shutter-shape needs --shutter");
  return parse_shape(flags.shape);
}

}  // namespace vernier::apps
