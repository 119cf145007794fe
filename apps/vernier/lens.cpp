// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <variant>

#include "apps/vernier/flags.h"
#include "scene/camera.h"
#include "scene/segment.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

constexpr float full_frame = 36;  // millimetres
constexpr float infinity = std::numeric_limits<float>::infinity();

struct Middle {};
struct Pixel {
  int x, y;
};
/// What is to be sharp: the middle of the picture, a distance in metres, or what a pixel shows.
using Focus = std::variant<Middle, float, Pixel>;

template <typename Number>
std::optional<Number> parse_all(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

Focus parse_focus(std::string_view text) {
  if (text.empty() || text == "auto") return Middle{};
  const size_t comma = text.find(',');
  if (comma == std::string_view::npos) {
    const auto metres = parse_all<float>(text);
    if (metres && *metres > 0) return *metres;
  } else {
    const auto x = parse_all<int>(text.substr(0, comma)), y = parse_all<int>(text.substr(comma + 1));
    if (x && y && *x >= 0 && *y >= 0) return Pixel{*x, *y};
  }
  throw Error(ErrorKind::usage,
              fmt::format("'{}' is nothing to focus on; expected auto, a distance in metres above 0, inf, or "
                          "the column and row X,Y of a pixel",
                          text));
}

/// Metres along the camera's axis to what it sees at a place of its picture.
std::optional<float> distance_at(const Scene& scene, const Camera& camera, const Vec2f& raster) {
  const Ray ray = camera.ray(raster);
  const auto hit = intersect_from_camera(scene, camera_segment(scene, ray));
  if (!hit) return std::nullopt;
  return camera.depth(ray, hit->t);
}

/// To what the middle of the picture shows, or where that is nothing, what lies nearest to it.
std::optional<float> distance_in_middle(const Scene& scene, const Camera& camera, const Vec2f& size) {
  constexpr int grid = 33;  // odd, so that the middle is among its places
  std::optional<float> distance;
  float nearest = infinity;
  for (int row = 0; row < grid; ++row)
    for (int column = 0; column < grid; ++column) {
      const Vec2f at(size.x * (float(column) + 0.5f) / grid, size.y * (float(row) + 0.5f) / grid);
      const float off_middle = (at - size / 2).length();
      if (off_middle >= nearest) continue;
      if (const auto here = distance_at(scene, camera, at)) {
        distance = here;
        nearest = off_middle;
      }
    }
  return distance;
}

float find_focus(const RenderSettings& settings, const std::string& asked, const Scene& scene,
                 NoticeLog& log) {
  const Focus focus = parse_focus(asked);
  if (const float* metres = std::get_if<float>(&focus)) return *metres;
  const Camera camera(settings.camera, settings.width, settings.height);
  if (const Pixel* pixel = std::get_if<Pixel>(&focus)) {
    if (pixel->x >= settings.width || pixel->y >= settings.height)
      throw Error(ErrorKind::usage, fmt::format("--focus {} lies outside of the picture of {}x{}", asked,
                                                settings.width, settings.height));
    const auto distance = distance_at(scene, camera, {float(pixel->x) + 0.5f, float(pixel->y) + 0.5f});
    if (!distance)
      throw Error(ErrorKind::usage,
                  fmt::format("--focus {}: that pixel shows no surface to focus on; name another, or a "
                              "distance in metres",
                              asked));
    return *distance;
  }
  const auto distance = distance_in_middle(scene, camera, {float(settings.width), float(settings.height)});
  if (!distance)
    log.add({Notice::Severity::info, {}, "the lens has nothing to focus on, and is focused at infinity"});
  else if (asked.empty())
    log.add({Notice::Severity::info,
             {},
             fmt::format("focused {:.3g} m away, on the middle of the picture; --focus METRES or X,Y "
                         "focuses elsewhere",
                         *distance)});
  return distance.value_or(infinity);
}

}  // namespace

void add_lens_flags(CLI::App& command, LensFlags& flags) {
  command.add_option("--fstop", flags.fstop, "blur what is out of focus by a lens of this f-number: 2.8")
      ->transform(real_number(1e-3, 1e6))
      ->type_name("N");
  command
      .add_option("--focus", flags.focus,
                  "distance that is sharp: metres, what a pixel shows, or auto "
                  "(what the middle shows)")
      ->check(parsed_by(parse_focus))
      ->type_name("METRES|X,Y|auto");
  command
      .add_option("--sensor", flags.sensor,
                  "width of the sensor, on the picture's longer side (36, full frame)")
      ->transform(real_number(1e-3, 1e6))
      ->type_name("MM");
}

std::string lens_text(const Lens& lens) {
  return fmt::format(
      "{:.3g} mm f/{:.3g}, focused at {}", 1000 * lens.focal_length, lens.fstop,
      std::isinf(lens.focus_distance) ? "infinity" : fmt::format("{:.4g} m", lens.focus_distance));
}

nlohmann::ordered_json to_json(const Lens& lens) {
  const bool is_finite = std::isfinite(lens.focus_distance);
  return {{"fstop", lens.fstop},
          {"focal_length", lens.focal_length},
          {"focus_distance", is_finite ? nlohmann::ordered_json(lens.focus_distance) : nullptr}};
}

std::optional<Lens> fit_lens(RenderSettings& settings, const LensFlags& flags, const Scene& scene,
                             NoticeLog& log) {
  if (!flags.fstop) return std::nullopt;
  CameraDescription& camera = settings.camera;
  if (camera.kind != CameraDescription::Kind::perspective)
    throw Error(ErrorKind::usage,
                fmt::format("camera {} is orthographic, and sees everything sharp; --fstop needs a "
                            "perspective camera",
                            camera.name));
  const float sensor = flags.sensor.value_or(full_frame) / 1000;
  const float longer = std::max(1.f, float(settings.width) / float(settings.height));
  Lens lens;
  lens.fstop = *flags.fstop;
  lens.focal_length = sensor / 2 / (std::tan(camera.yfov / 2) * longer);
  lens.focus_distance = find_focus(settings, flags.focus, scene, log);
  camera.lens_radius = lens.focal_length / lens.fstop / 2;
  camera.focus_distance = lens.focus_distance;
  return lens;
}

}  // namespace vernier::apps
