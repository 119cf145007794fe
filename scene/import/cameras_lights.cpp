#include "scene/import/cameras_lights.h"

#include <fmt/format.h>

namespace vernier {
namespace {

CameraDescription read_camera(const Document& document, int index) {
  const auto& source = document.model().cameras[size_t(index)];
  CameraDescription camera;
  camera.name = source.name;
  if (source.type == "perspective") {
    camera.yfov = float(source.perspective.yfov);
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

PunctualLightDescription read_light(const Document& document, int index) {
  const auto& source = document.model().lights[size_t(index)];
  const std::string place = fmt::format("/extensions/KHR_lights_punctual/lights/{}", index);
  using Kind = PunctualLightDescription::Kind;
  PunctualLightDescription light;
  light.name = source.name;
  light.kind = source.type == "spot" ? Kind::spot : source.type == "point" ? Kind::point : Kind::directional;
  if (source.color.size() == 3)
    light.color = Rgb(float(source.color[0]), float(source.color[1]), float(source.color[2]));
  if (!(light.color.x >= 0 && light.color.y >= 0 && light.color.z >= 0))
    document.fail(place + "/color", "a light's colour must not be negative");
  light.intensity = float(source.intensity);
  if (light.kind != Kind::directional && source.range > 0) light.range = float(source.range);
  if (light.kind == Kind::spot) {
    light.inner_cone = float(source.spot.innerConeAngle);
    light.outer_cone = float(source.spot.outerConeAngle);
    if (!(light.inner_cone < light.outer_cone))
      document.fail(place + "/spot", "innerConeAngle must be smaller than outerConeAngle");
  }
  return light;
}

}  // namespace

void add_cameras_and_lights(const Document& document, const NodePlaces& places, SceneDescription& scene) {
  for (const int index : places.shown) {
    const auto& node = document.model().nodes[size_t(index)];
    const std::string place = fmt::format("/nodes/{}", index);
    const auto& to_world = places.to_world[size_t(index)];
    if (node.camera >= 0) {
      scene.cameras.push_back(read_camera(document, node.camera));
      if (scene.cameras.back().name.empty()) scene.cameras.back().name = node.name;
      scene.cameras.back().to_world = to_transform(document, to_world, place);
    }
    const auto light = node.extensions.find("KHR_lights_punctual");
    if (light != node.extensions.end()) {
      scene.lights.push_back(read_light(document, light->second.Get("light").GetNumberAsInt()));
      if (scene.lights.back().name.empty()) scene.lights.back().name = node.name;
      scene.lights.back().to_world = to_transform(document, to_world, place);
    }
  }
}

}  // namespace vernier
