// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/choose_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/names.h"
#include "core/base/quantities.h"
#include "scene/framing.h"
#include "scene/subject.h"
#include "scene/turntable.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

constexpr float default_aspect = 16.0f / 9;

std::optional<size_t> parse_index(const std::string& text) {
  size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return index;
}

std::string label(std::span<const CameraDescription> cameras, size_t index) {
  return fmt::format("{}{}", index,
                     cameras[index].name.empty() ? "" : fmt::format(" ({})", cameras[index].name));
}

Vec3f to_vector(const std::string& text) {
  const auto [x, y, z] = parse_point(text);
  return {x, y, z};
}

void look_from(CameraDescription& camera, const CameraFlags& flags, const Bounds& seen) {
  const Vec3f from = to_vector(flags.look_from);
  const Vec3f at = flags.look_at.empty() ? seen.center() : to_vector(flags.look_at);
  const Vec3f up = flags.up.empty() ? Vec3f(0, 1, 0) : to_vector(flags.up);
  if (!(length(from - at) > 0))
    throw Error(ErrorKind::usage,
                fmt::format("--look-from {} is the point looked at{}", flags.look_from,
                            flags.look_at.empty() ? ", the scene's centre; --look-at gives another" : ""));
  const Vec3f back = normalize(from - at);
  if (!(length(cross(up, back)) > 1e-6f * length(up))) {
    if (!flags.up.empty())
      throw Error(ErrorKind::usage, fmt::format("--up {} lies along the view; give another", flags.up));
    turn(camera, back, {0, 0, back.y > 0 ? -1.f : 1.f});
  } else {
    turn(camera, back, up);
  }
  camera.name = "look-from";
  camera.to_world.origin = from;
}

float shape(const CameraDescription& camera) {
  if (camera.kind == CameraDescription::Kind::panorama) return 2;
  float aspect = camera.aspect;
  if (camera.kind == CameraDescription::Kind::orthographic) aspect = std::abs(camera.xmag / camera.ymag);
  return std::isfinite(aspect) && aspect > 0 ? aspect : default_aspect;
}

/// Widens, zooms and flattens a camera that stands where it shall. `seen` is what an orthographic one made
/// of a perspective one goes on to see at the same size.
void adjust_lens(CameraDescription& camera, const CameraFlags& flags, const Bounds& seen) {
  using Kind = CameraDescription::Kind;
  const float aspect = shape(camera);
  if (flags.fov) {
    if (camera.kind == Kind::orthographic)
      throw Error(ErrorKind::usage,
                  fmt::format("camera {} is orthographic and has no --fov; --zoom or --ortho HEIGHT changes "
                              "how much it sees",
                              camera.name));
    camera.yfov = *flags.fov * pi / 180;
  }
  if (flags.ortho && camera.kind == Kind::perspective) {
    const float distance = dot(camera.to_world.origin - seen.center(), normalize(camera.to_world.z));
    camera.kind = Kind::orthographic;
    camera.ymag = std::max(distance, 1e-6f) * std::tan(camera.yfov / 2);
  }
  if (flags.ortho_height) camera.ymag = *flags.ortho_height / 2;
  if (flags.zoom != 1) {
    camera.ymag /= flags.zoom;
    camera.yfov = 2 * std::atan(std::tan(camera.yfov / 2) / flags.zoom);
  }
  if (flags.ortho || flags.zoom != 1) camera.xmag = camera.ymag * aspect;
}

/// From where the camera stands, upright, so that --env shows the picture's directions where they are.
void look_around(CameraDescription& camera) {
  camera.kind = CameraDescription::Kind::panorama;
  const auto set_upright = [](Transform& place) { place = {.origin = place.origin}; };
  set_upright(camera.to_world);
  for (Transform& moment : camera.moments) set_upright(moment);
}

FittedView view_of(const CameraFlags& flags) {
  const auto radians = [](float degrees) { return degrees * pi / 180; };
  FittedView view;
  if (flags.azimuth) view.azimuth = radians(*flags.azimuth);
  if (flags.elevation) view.elevation = radians(*flags.elevation);
  view.roll = radians(flags.roll);
  if (flags.fov) view.yfov = radians(*flags.fov);
  view.orthographic = flags.ortho;
  if (!flags.fit.empty()) view.margin = parse_margin(flags.fit);
  return view;
}

void note_fitting(const CameraFlags& flags, const Subject& subject, NoticeLog& log) {
  if (subject.empty()) {
    log.add({Notice::Severity::info, {}, "there is nothing to see in the scene; looking at the origin"});
    return;
  }
  if (!flags.orbits() && !flags.ortho)
    log.add({Notice::Severity::info,
             {},
             "the scene has no camera; using one fitted to it, --azimuth and --elevation go around it"});
  const size_t grounds = flags.ground ? 1 : 0;
  if (subject.left_out() > grounds)
    log.add({Notice::Severity::info,
             {},
             fmt::format("the camera is fitted without {} far larger {}; --look-from and --look-at see more",
                         subject.left_out() - grounds,
                         subject.left_out() - grounds == 1 ? "object" : "objects")});
  if (subject.strays() > 0)
    log.add(
        {Notice::Severity::info,
         {},
         fmt::format("the camera is fitted without {} small and far away; --look-from and --look-at see more",
                     subject.strays() == 1 ? "an object that is" : "objects that are")});
}

}  // namespace

std::optional<CameraDescription> choose_camera(std::span<const CameraDescription> cameras,
                                               const CameraFlags& flags, NoticeLog& log) {
  const std::string& choice = flags.camera;
  if (flags.orbits() || !flags.look_from.empty() || (choice.empty() && cameras.empty())) return {};
  size_t chosen = 0;
  if (choice.empty()) {
    if (cameras.size() > 1)
      log.add({Notice::Severity::info,
               {},
               fmt::format("the scene has {} cameras; using {}, --camera picks another", cameras.size(),
                           label(cameras, 0))});
  } else {
    const auto named =
        std::find_if(cameras.begin(), cameras.end(), [&](const auto& c) { return c.name == choice; });
    chosen = named != cameras.end() ? size_t(named - cameras.begin())
                                    : parse_index(choice).value_or(cameras.size());
    if (chosen >= cameras.size()) {
      std::vector<std::string> labels;
      for (size_t i = 0; i < cameras.size(); ++i) labels.push_back(label(cameras, i));
      throw_unknown_name("camera", choice, labels);
    }
  }
  CameraDescription camera = cameras[chosen];
  if (!camera.defect.empty()) throw Error(ErrorKind::input, camera.defect);
  for (const CameraDescription& other : cameras)
    if (!other.defect.empty())
      log.add({Notice::Severity::warning, {}, fmt::format("{}; it is not the one used", other.defect)});
  if (camera.name.empty()) camera.name = std::to_string(chosen);
  return camera;
}

std::vector<LabelledCamera> all_cameras(std::span<const CameraDescription> cameras, NoticeLog& log) {
  std::vector<LabelledCamera> usable;
  for (size_t i = 0; i < cameras.size(); ++i) {
    CameraDescription camera = cameras[i];
    if (!camera.defect.empty()) {
      log.add({Notice::Severity::warning, {}, fmt::format("{}; it is left out", camera.defect)});
      continue;
    }
    const auto same_name = [&](const CameraDescription& other) { return other.name == camera.name; };
    const bool is_unique = std::count_if(cameras.begin(), cameras.end(), same_name) == 1;
    const std::string number = std::to_string(i);
    if (camera.name.empty()) camera.name = number;
    std::string label = is_unique ? camera.name : number;
    usable.push_back({std::move(camera), std::move(label)});
  }
  if (usable.empty()) throw Error(ErrorKind::input, cameras[0].defect);
  return usable;
}

CameraDescription place_camera(const std::optional<CameraDescription>& chosen, const CameraFlags& flags,
                               const SceneGeometry& geometry, float aspect, NoticeLog& log) {
  const Subject subject(geometry);
  const Bounds seen = subject.bounds_to_see();
  CameraDescription camera;
  if (chosen) {
    camera = *chosen;
    roll(camera, flags.roll * pi / 180);
  } else if (!flags.look_from.empty()) {
    camera.yfov = FittedView{}.yfov;
    look_from(camera, flags, seen);
    roll(camera, flags.roll * pi / 180);
  } else {
    note_fitting(flags, subject, log);
    const float shape = aspect > 0 ? aspect : default_aspect;
    camera = flags.turns ? fitted_turntable_camera(subject, shape, view_of(flags))
                         : fitted_camera(subject, shape, view_of(flags));
  }
  if (flags.panorama)
    look_around(camera);
  else
    adjust_lens(camera, flags, seen);
  return camera;
}

void fill_in_size(RenderSettings& options, const CameraDescription& camera) {
  if (options.width > 0) return;
  const double aspect = shape(camera);
  const double longer = std::abs(aspect - 1) < 1e-3 ? 1024 : 1280;
  options.width = std::max(1, static_cast<int>(std::lround(aspect >= 1 ? longer : longer * aspect)));
  options.height = std::max(1, static_cast<int>(std::lround(aspect >= 1 ? longer / aspect : longer)));
}

float asked_aspect(const std::string& size) {
  if (size.empty()) return 0;
  const PixelSize pixels = parse_pixel_size(size);
  return float(pixels.width) / float(pixels.height);
}

}  // namespace vernier::apps
