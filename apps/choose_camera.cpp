#include "apps/choose_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/names.h"
#include "scene/camera.h"

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

float shape(const CameraDescription& camera) {
  float aspect = camera.aspect;
  if (camera.kind == CameraDescription::Kind::orthographic) aspect = std::abs(camera.xmag / camera.ymag);
  return std::isfinite(aspect) && aspect > 0 ? aspect : default_aspect;
}

}  // namespace

std::optional<CameraDescription> choose_camera(std::span<const CameraDescription> cameras,
                                               const std::string& choice, NoticeLog& log) {
  if (choice.empty() && cameras.empty()) return {};
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

CameraDescription fit_camera(const Bounds& bounds, const RenderOptions& options, NoticeLog& log) {
  const bool empty = bounds.empty();
  log.add({Notice::Severity::info,
           {},
           empty ? "the scene has no camera and nothing to see; looking at the origin"
                 : "the scene has no camera; using one fitted to its bounds"});
  Bounds seen = bounds;
  if (empty) {
    seen.add(Vec3f(-1));
    seen.add(Vec3f(1));
  }
  const bool sized = options.width > 0;
  CameraDescription camera =
      fitted_camera(seen, sized ? float(options.width) / float(options.height) : default_aspect);
  camera.name = "fitted";
  return camera;
}

void fill_in_size(RenderOptions& options, const CameraDescription& camera) {
  if (options.width > 0) return;
  const double aspect = shape(camera);
  const double longer = std::abs(aspect - 1) < 1e-3 ? 1024 : 1280;
  options.width = std::max(1, static_cast<int>(std::lround(aspect >= 1 ? longer : longer * aspect)));
  options.height = std::max(1, static_cast<int>(std::lround(aspect >= 1 ? longer / aspect : longer)));
}

}  // namespace vernier::apps
