// SPDX-License-Identifier: Apache-2.0
#include "scene/import/cameras_lights.h"

#include <fmt/format.h>

#include <numbers>
#include <optional>

namespace vernier {
namespace {

CameraDescription read_camera(const Document& document, int index, std::vector<Notice>& notices) {
  const auto& source = document.model().cameras[size_t(index)];
  CameraDescription camera;
  camera.name = source.name;
  if (source.type == "perspective") {
    constexpr double widest = 3.1;  // radians
    if (source.perspective.yfov > widest)
      notices.push_back({Notice::Severity::warning, fmt::format("/cameras/{}/perspective/yfov", index),
                         fmt::format("{:g} radians are more than a plane picture can show; {} are taken",
                                     source.perspective.yfov, widest)});
    camera.yfov = float(std::min(source.perspective.yfov, widest));
    camera.aspect = float(source.perspective.aspectRatio);
    return camera;
  }
  camera.kind = CameraDescription::Kind::orthographic;
  camera.xmag = float(std::abs(source.orthographic.xmag));
  camera.ymag = float(std::abs(source.orthographic.ymag));
  if (!(camera.xmag > 0 && camera.ymag > 0))
    document.fail(fmt::format("/cameras/{}/orthographic", index), "xmag and ymag must not be zero");
  camera.aspect = camera.xmag / camera.ymag;
  return camera;
}

class LightReader {
 public:
  LightReader(const Document& document, int index, std::vector<Notice>& notices)
      : source_(document.model().lights[size_t(index)]),
        place_(fmt::format("/extensions/KHR_lights_punctual/lights/{}", index)),
        notices_(notices) {}

  PunctualLightDescription read() {
    using Kind = PunctualLightDescription::Kind;
    light_.name = source_.name;
    light_.kind = source_.type == "spot"    ? Kind::spot
                  : source_.type == "point" ? Kind::point
                                            : Kind::directional;
    for (int i = 0; i < 3 && source_.color.size() == 3; ++i)
      light_.color[i] = not_negative(source_.color[size_t(i)], "/color");
    light_.intensity = not_negative(source_.intensity, "/intensity");
    if (light_.kind != Kind::directional && source_.range > 0) light_.range = float(source_.range);
    if (light_.kind == Kind::spot) read_cone();
    return light_;
  }

 private:
  /// An inner angle that reaches the outer one makes an edge as sharp as some exporters want theirs. Angles
  /// that differ less than single precision shows need no words.
  void read_cone() {
    double inner = source_.spot.innerConeAngle, outer = source_.spot.outerConeAngle;
    constexpr double right_angle = std::numbers::pi / 2, rounding = 1e-4;
    if (outer > right_angle + rounding)
      warn("/spot/outerConeAngle", "the angle is above pi/2 and was clamped");
    outer = std::min(outer, right_angle);
    if (inner >= outer)
      warn("/spot", "innerConeAngle is not smaller than outerConeAngle; the cone has a sharp edge");
    light_.inner_cone = float(std::min(inner, outer));
    light_.outer_cone = float(outer);
  }

  float not_negative(double value, const char* property) {
    if (value < 0) warn(property, "a light takes no light away; the negative value was clamped to 0");
    return float(std::max(value, 0.0));
  }
  void warn(const std::string& property, const std::string& text) {
    notices_.push_back({Notice::Severity::warning, place_ + property, text});
  }

  const tinygltf::Light& source_;
  std::string place_;
  std::vector<Notice>& notices_;
  PunctualLightDescription light_;
};

/// "camera 'front' of node 'rig'", names left out where there are none.
std::string described(const char* kind, const std::string& name, const FileNode& node) {
  return fmt::format("{}{} of the node{}", kind, name.empty() ? "" : fmt::format(" '{}'", name),
                     node.name.empty() ? "" : fmt::format(" '{}'", node.name));
}

bool is_usable(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && v != Vec3d(0, 0, 0);
}

/// Unit vector; scaled first, so that no square overflows or vanishes.
Vec3d direction(const Vec3d& v) {
  const Vec3d a = abs(v);
  return normalize(v / std::max(a.x, std::max(a.y, a.z)));
}

/// Where a camera or light is and how it is turned, as an orthonormal frame, since scale and shear of its
/// node do not count (glTF 2.0, 3.10.2); none when the matrix leaves its -z no direction, or, for a camera,
/// its +y none across it.
std::optional<Transform> frame_of(const Imath::M44d& m, bool needs_up) {
  const Vec3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
  const Vec3f origin(Vec3d(m[3][0], m[3][1], m[3][2]));
  if (!is_usable(z) || !is_finite(origin)) return std::nullopt;
  const Vec3d back = direction(z);
  Vec3d right(0, 0, 0);
  if (is_usable(y)) right = cross(direction(y), back);
  // Scaled flat, y says nothing, but x still may.
  if (!(length_squared(right) > 1e-12) && is_usable(x)) right = direction(x) - back * dot(direction(x), back);
  if (!(length_squared(right) > 1e-12)) {
    if (needs_up) return std::nullopt;
    right = cross(std::abs(back.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0), back);
  }
  right = direction(right);
  return Transform{Vec3f(right), Vec3f(cross(back, right)), Vec3f(back), origin};
}

/// The frame of a light that shines the same to all sides.
std::optional<Transform> position_of(const Imath::M44d& m) {
  Transform frame;
  frame.origin = Vec3f(Vec3d(m[3][0], m[3][1], m[3][2]));
  if (!is_finite(frame.origin)) return std::nullopt;
  return frame;
}

}  // namespace

void add_cameras_and_lights(const Document& document, const NodePlaces& places, SceneDescription& scene) {
  constexpr const char* reason =
      "the node's matrix gives it no direction (a scale of 0, or values too large)";
  for (const int index : places.shown) {
    const auto& node = document.nodes()[size_t(index)];
    const std::string place = fmt::format("/nodes/{}", index);
    const auto& to_world = places.to_world[size_t(index)];
    const auto use = node.extensions.find("KHR_lights_punctual");
    if (node.camera >= 0 || use != node.extensions.end()) check_affine(document, to_world, place);
    if (node.camera >= 0) {
      CameraDescription camera = read_camera(document, node.camera, scene.notices);
      if (camera.name.empty()) camera.name = node.name;
      if (const auto frame = frame_of(to_world, true))
        camera.to_world = *frame;
      else
        camera.defect = fmt::format("{}: {}: {} cannot be used: {}", document.files().scene_path(), place,
                                    described("the camera", camera.name, node), reason);
      scene.cameras.push_back(std::move(camera));
    }
    if (use == node.extensions.end()) continue;
    const int light_index = use->second.Get("light").GetNumberAsInt();
    PunctualLightDescription light = LightReader(document, light_index, scene.notices).read();
    if (light.name.empty()) light.name = node.name;
    const auto frame = light.kind == PunctualLightDescription::Kind::point ? position_of(to_world)
                                                                           : frame_of(to_world, false);
    if (!frame) {
      scene.notices.push_back(
          {Notice::Severity::warning, place,
           fmt::format("{} is left out: {}", described("the light", light.name, node), reason)});
      continue;
    }
    light.to_world = *frame;
    scene.lights.push_back(std::move(light));
  }
}

}  // namespace vernier
