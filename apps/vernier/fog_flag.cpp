// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/fog_flag.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/quantities.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& problem) {
  throw Error(
      ErrorKind::usage,
      fmt::format("--fog {}: {}; expected DENSITY per metre, and if need be a colour, the mean cosine and a "
                  "radius, such as 0.1 or 0.1,#ffe0c0,0.6,20",
                  text, problem));
}

std::optional<float> as_number(std::string_view text) {
  float value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

float number(const std::string& text, std::string_view part, const char* what, float low, float high) {
  const auto value = as_number(part);
  if (!value || *value < low || *value > high)
    refuse(text, fmt::format("'{}' is no {} from {} to {}", part, what, low, high));
  return *value;
}

/// sRGB, or one number for all channels.
Rgb albedo(const std::string& text, std::string_view part) {
  if (const auto gray = as_number(part); gray && part.size() < 6) {
    if (*gray < 0 || *gray > 1) refuse(text, fmt::format("'{}' is no albedo from 0 to 1", part));
    return Rgb(*gray);
  }
  try {
    const auto [r, g, b] = parse_color(part);
    return {r, g, b};
  } catch (const Error&) {
    refuse(text, fmt::format("'{}' is no colour", part));
  }
}

}  // namespace

void add_fog_flag(CLI::App& command, std::string& fog) {
  command
      .add_option(
          "--fog", fog,
          "fills the air about the scene with what scatters light: part of it per metre, its colour (white), "
          "the mean cosine of the deflection (0), and the radius in metres of the ball that it fills (four "
          "times the scene's)")
      ->type_name("DENSITY[,COLOUR[,G[,RADIUS]]]");
}

Fog parse_fog(const std::string& text) {
  Fog fog;
  if (text.empty()) return fog;
  std::vector<std::string_view> parts;
  for (std::string_view rest = text;; rest.remove_prefix(rest.find(',') + 1)) {
    parts.push_back(rest.substr(0, rest.find(',')));
    if (rest.find(',') == std::string_view::npos) break;
  }
  if (parts.size() > 4) refuse(text, fmt::format("{} values", parts.size()));
  fog.density = number(text, parts[0], "density", 0, 1e6f);
  if (parts.size() > 1) fog.albedo = albedo(text, parts[1]);
  if (parts.size() > 2) fog.anisotropy = number(text, parts[2], "mean cosine", -0.999f, 0.999f);
  if (parts.size() > 3) fog.radius = number(text, parts[3], "radius", 1e-6f, 1e12f);
  return fog;
}

}  // namespace vernier::apps
