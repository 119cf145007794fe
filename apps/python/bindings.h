// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vernier/vernier.h"

// vernier._core: libvernier as plain classes and functions. What users see is the package vernier beside it,
// which is written in Python; cameras and settings travel between the two as the JSON of RenderSettings.

namespace vernier::python {

namespace py = pybind11;

// Each adds its part to the module.
void bind_errors(py::module_& module);
void bind_scene(py::module_& module);
void bind_picture(py::module_& module);
void bind_session(py::module_& module);

/// A picture that arrays of Python may look into.
struct Picture {
  std::shared_ptr<LayeredImage> image;

  explicit Picture(LayeredImage its_image) : image(std::make_shared<LayeredImage>(std::move(its_image))) {}
};

/// What answers rays, with what is told of the scene that it was built from.
struct BuiltScene {
  /// Throws Error, also on a ground that is neither empty nor the name of a kind.
  BuiltScene(SceneFile& file, const ImportOptions& options, const std::string& ground,
             const std::string& accelerator);

  std::shared_ptr<Scene> scene;
  std::string source, hash;
  std::vector<std::string> objects;  ///< names of the mesh instances, in the order of the layer `id`
  std::vector<CameraDescription> cameras;
  std::shared_ptr<const EnvironmentDescription> environment;  ///< the file's own
  std::vector<FeatureUse> features;
  std::vector<Notice> notices;
  std::optional<std::array<Vec3f, 2>> bounds;  ///< lower and upper corner of all there is; none: nothing is
};

/// The camera of settings in JSON.
CameraDescription camera_from(const std::string& settings);

/// Figures of a render by the names that they have in C++.
py::dict to_dict(const RenderStatus& status);

}  // namespace vernier::python
