// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>

#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "apps/python/bindings.h"

namespace vernier::python {
namespace {

using Environment = std::shared_ptr<const EnvironmentDescription>;
using Corner = std::array<float, 3>;

std::unique_ptr<SceneFile> parse(const std::string& name, const py::bytes& bytes) {
  const std::string_view view = bytes;
  const std::span data(reinterpret_cast<const uint8_t*>(view.data()), view.size());
  const py::gil_scoped_release unlocked;
  return std::make_unique<SceneFile>(name, data);
}

/// When an animation poses the scene, in seconds, and when the shutter opens and closes from then on.
struct Times {
  std::optional<double> time;
  std::optional<std::array<double, 2>> shutter;
};

ImportOptions import_options(const std::string& variant, const Times& times, const std::string& animation,
                             bool strict, uint64_t max_memory) {
  ImportOptions options;
  options.variant = variant;
  options.time = times.time;
  if (const auto& shutter = times.shutter) {
    if (!((*shutter)[0] < (*shutter)[1]))
      throw Error(ErrorKind::usage, "shutter: expected the seconds at which it opens and then closes");
    options.shutter = Shutter{(*shutter)[0], (*shutter)[1]};
  }
  options.animation = animation;
  options.strict = strict;
  // Any picture of it may ask for smaller copies of the textures.
  options.memory = {.bytes = max_memory, .has_mips = true};
  return options;
}

GroundKind ground_kind(const std::string& name) {
  if (name == "matte") return GroundKind::matte;
  if (name == "shadow") return GroundKind::shadow;
  throw Error(ErrorKind::usage, "unknown ground '" + name + "'; there are: matte, shadow");
}

std::optional<std::array<Vec3f, 2>> bounds_of(const SceneDescription& description) {
  std::optional<std::array<Vec3f, 2>> bounds;
  for (const InstanceDescription& instance : description.instances)
    for (const Vec3f& position : description.meshes[instance.mesh].positions) {
      const Vec3f at = instance.to_world.point(position);
      if (!bounds) bounds = {at, at};
      *bounds = {min((*bounds)[0], at), max((*bounds)[1], at)};
    }
  return bounds;
}

std::optional<std::array<Corner, 2>> corners(const BuiltScene& built) {
  if (!built.bounds) return std::nullopt;
  const auto& [lower, upper] = *built.bounds;
  return std::array<Corner, 2>{{{lower.x, lower.y, lower.z}, {upper.x, upper.y, upper.z}}};
}

/// Settings with this camera, for Python to take it out of.
std::string to_json(const CameraDescription& camera) {
  RenderSettings settings;
  settings.camera = camera;
  return settings.to_json();
}

std::string fitted(const BuiltScene& built, float aspect, const FittedView& view) {
  return to_json(fitted_camera(*built.scene, aspect, view));
}

/// As --env-rotate and --env-scale change it; `rotation` in radians.
Environment changed(Environment environment, float rotation, float scale) {
  if (rotation == 0 && scale == 1) return environment;
  auto copy = std::make_shared<EnvironmentDescription>(*environment);
  copy->rotation = std::remainder(rotation + copy->rotation, 2 * pi);
  copy->scale *= scale;
  return copy;
}

Environment from_array(const py::array_t<float, py::array::c_style | py::array::forcecast>& pixels) {
  Image picture(int(pixels.shape(1)), int(pixels.shape(0)), 3);
  std::copy_n(pixels.data(), picture.values.size(), picture.values.begin());
  auto environment = std::make_shared<EnvironmentDescription>();
  environment->picture = std::make_shared<const Image>(std::move(picture));
  return environment;
}

py::tuple to_tuple(const Notice& notice) {
  return py::make_tuple(notice.severity == Notice::Severity::warning ? "warning" : "info", notice.place,
                        notice.text);
}

py::tuple to_tuple(const FeatureUse& use) {
  constexpr std::array names{"exact", "approximated", "ignored"};
  return py::make_tuple(use.name, names[size_t(use.status)], use.note);
}

template <typename T>
py::list to_list(const std::vector<T>& all) {
  py::list list;
  for (const T& one : all) list.append(to_tuple(one));
  return list;
}

void bind_built(py::module_& module) {
  py::class_<BuiltScene, std::shared_ptr<BuiltScene>>(module, "BuiltScene")
      .def(
          py::init([](SceneFile& file, const std::string& variant, std::optional<double> time,
                      std::optional<std::array<double, 2>> shutter, const std::string& animation, bool strict,
                      uint64_t max_memory, const std::string& ground, const std::string& accelerator) {
            const py::gil_scoped_release unlocked;
            const ImportOptions options =
                import_options(variant, {time, shutter}, animation, strict, max_memory);
            return std::make_shared<BuiltScene>(file, options, ground, accelerator);
          }),
          py::arg("file"), py::arg("variant"), py::arg("time"), py::arg("shutter"), py::arg("animation"),
          py::arg("strict"), py::arg("max_memory"), py::arg("ground"), py::arg("accelerator"))
      .def_readonly("source", &BuiltScene::source)
      .def_readonly("hash", &BuiltScene::hash)
      .def_readonly("objects", &BuiltScene::objects)
      .def_property_readonly("cameras",
                             [](const BuiltScene& built) {
                               py::list list;
                               for (const CameraDescription& camera : built.cameras)
                                 list.append(py::make_tuple(to_json(camera), camera.defect));
                               return list;
                             })
      .def_property_readonly("own_environment",
                             [](const BuiltScene& built) {
                               return std::const_pointer_cast<EnvironmentDescription>(built.environment);
                             })
      .def_property_readonly("features", [](const BuiltScene& built) { return to_list(built.features); })
      .def_property_readonly("notices", [](const BuiltScene& built) { return to_list(built.notices); })
      .def_property_readonly("bounds", corners)
      .def(
          "set_environment",
          [](BuiltScene& built, const std::shared_ptr<EnvironmentDescription>& environment) {
            const py::gil_scoped_release unlocked;
            set_environment(*built.scene, environment);
          },
          py::arg("environment").none(true))
      .def(
          "fill_air",
          [](BuiltScene& built, float density, const std::array<float, 3>& albedo, float anisotropy,
             float radius) {
            fill_air(*built.scene, {density, {albedo[0], albedo[1], albedo[2]}, anisotropy, radius});
          },
          py::arg("density"), py::arg("albedo"), py::arg("anisotropy"), py::arg("radius"))
      .def(
          "is_dark",
          [](const BuiltScene& built, const std::string& settings) {
            const py::gil_scoped_release unlocked;
            return is_dark(*built.scene, RenderSettings::from_json(settings));
          },
          py::arg("settings"))
      .def(
          "fitted_camera",
          [](const BuiltScene& built, float aspect, std::optional<float> azimuth,
             std::optional<float> elevation, float roll, float yfov, bool orthographic, float margin) {
            const py::gil_scoped_release unlocked;
            return fitted(built, aspect, {azimuth, elevation, roll, yfov, orthographic, margin});
          },
          py::arg("aspect"), py::arg("azimuth"), py::arg("elevation"), py::arg("roll"), py::arg("yfov"),
          py::arg("orthographic"), py::arg("margin"));
}

}  // namespace

BuiltScene::BuiltScene(SceneFile& file, const ImportOptions& options, const std::string& ground,
                       const std::string& accelerator) {
  SceneDescription description = file.describe(options);
  bounds = bounds_of(description);
  if (!ground.empty()) add_ground(description, ground_kind(ground));
  source = description.source;
  hash = description.hash;
  for (const InstanceDescription& instance : description.instances) objects.push_back(instance.name);
  cameras = description.cameras;
  environment = description.environment;
  features = description.features;
  notices = description.notices;
  check_scene_size(description, options.memory);
  scene = build_scene(std::move(description), {accelerator});
  const auto& later = notices_of(*scene);
  if (options.strict) refuse_warnings(source, later);
  notices.insert(notices.end(), later.begin(), later.end());
}

CameraDescription camera_from(const std::string& settings) {
  return RenderSettings::from_json(settings).camera;
}

void bind_scene(py::module_& module) {
  py::class_<SceneFile>(module, "SceneFile")
      .def(py::init<const std::string&, bool>(), py::arg("path"), py::arg("allow_outside_files"),
           py::call_guard<py::gil_scoped_release>())
      .def_static("parse", parse, py::arg("name"), py::arg("bytes"))
      .def_property_readonly("variants", &SceneFile::variants);

  // The library shares environments as constant ones, which pybind11 has no holder for.
  const auto mutable_one = [](Environment environment) {
    return std::const_pointer_cast<EnvironmentDescription>(environment);
  };
  py::class_<EnvironmentDescription, std::shared_ptr<EnvironmentDescription>>(module, "Environment")
      .def_static(
          "built_in",
          [mutable_one](const std::string& name, const std::string& settings, float rotation, float scale) {
            return mutable_one(changed(built_in_environment(name, camera_from(settings)), rotation, scale));
          },
          py::arg("name"), py::arg("settings"), py::arg("rotation"), py::arg("scale"))
      .def_static(
          "read",
          [mutable_one](const std::string& path, float rotation, float scale) {
            const py::gil_scoped_release unlocked;
            return mutable_one(changed(read_environment(path), rotation, scale));
          },
          py::arg("path"), py::arg("rotation"), py::arg("scale"))
      .def_static(
          "from_array",
          [mutable_one](const py::array_t<float, py::array::c_style | py::array::forcecast>& pixels,
                        float rotation,
                        float scale) { return mutable_one(changed(from_array(pixels), rotation, scale)); },
          py::arg("pixels"), py::arg("rotation"), py::arg("scale"));
  bind_built(module);
}

}  // namespace vernier::python
