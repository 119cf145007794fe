// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>

#include <algorithm>
#include <utility>

#include "apps/python/bindings.h"

namespace vernier::python {
namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// (height, width, channels), read-only, of the picture's own memory, which the array keeps.
py::array values(const Picture& picture) {
  const Image& image = picture.image->image;
  const py::capsule keeper(new std::shared_ptr<LayeredImage>(picture.image), [](void* pointer) {
    delete static_cast<std::shared_ptr<LayeredImage>*>(pointer);
  });
  py::array_t<float> array({image.height, image.width, image.channels}, image.values.data(), keeper);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// Of an array (height, width, channels).
Picture from_array(const Floats& array, const std::vector<std::string>& names, bool linear) {
  LayeredImage layered{
      Image(int(array.shape(1)), int(array.shape(0)), int(array.shape(2))), names, {}, linear};
  std::copy_n(array.data(), layered.image.values.size(), layered.image.values.begin());
  return Picture(std::move(layered));
}

DisplayOptions display(const std::string& view, float exposure, const std::string& config) {
  return {view, config, exposure};
}

py::array_t<uint8_t> shown(const Picture& picture, const std::string& view, float exposure,
                           const std::string& config) {
  Image8 shown;
  {
    const py::gil_scoped_release unlocked;
    shown = to_display(*picture.image, display(view, exposure, config));
  }
  py::array_t<uint8_t> array({shown.height, shown.width, shown.channels});
  std::copy(shown.values.begin(), shown.values.end(), array.mutable_data());
  return array;
}

py::bytes encoded(const Picture& picture, const std::string& format, const std::string& view, float exposure,
                  const std::string& config) {
  std::vector<unsigned char> bytes;
  {
    const py::gil_scoped_release unlocked;
    bytes = encode_picture(format, *picture.image, display(view, exposure, config));
  }
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The picture denoised, and its error before and after: None where it is not known.
py::tuple denoised(const Picture& picture, const std::string& filter) {
  std::optional<Picture> result;
  std::optional<DenoisedError> error;
  {
    const py::gil_scoped_release unlocked;
    result.emplace(LayeredImage(*picture.image));
    error = denoise(*result->image, filter);
  }
  py::object figures = py::none();
  if (error) figures = py::make_tuple(error->noisy, error->rel_rmse, error->low, error->high);
  return py::make_tuple(*result, figures);
}

py::tuple merged(const std::vector<std::string>& checkpoints, const std::string& layers) {
  std::optional<MergedRender> render;
  {
    const py::gil_scoped_release unlocked;
    render = merge(checkpoints, layers);
  }
  return py::make_tuple(Picture(std::move(render->picture)), to_dict(render->status));
}

}  // namespace

void bind_picture(py::module_& module) {
  const auto view = py::arg("view"), exposure = py::arg("exposure"), config = py::arg("config");
  py::class_<Picture>(module, "Picture")
      .def_static(
          "read",
          [](const std::string& path) {
            const py::gil_scoped_release unlocked;
            return Picture(read_picture(path));
          },
          py::arg("path"))
      .def_static("from_array", from_array, py::arg("array"), py::arg("names"), py::arg("linear"))
      .def_property_readonly("values", values)
      .def_property_readonly("channel_names",
                             [](const Picture& picture) { return picture.image->channel_names; })
      .def_property_readonly("linear", [](const Picture& picture) { return picture.image->linear; })
      .def_property(
          "metadata", [](const Picture& picture) { return picture.image->metadata; },
          [](Picture& picture, const Metadata& texts) { picture.image->metadata = texts; })
      .def(
          "write",
          [](const Picture& picture, const std::string& path, const std::string& view_name, float stops,
             const std::string& config_file) {
            const py::gil_scoped_release unlocked;
            write_picture(path, *picture.image, display(view_name, stops, config_file));
          },
          py::arg("path"), view, exposure, config)
      .def("encode", encoded, py::arg("format"), view, exposure, config)
      .def("to_display", shown, view, exposure, config)
      .def("denoise", denoised, py::arg("filter"));
  module.def(
      "compare",
      [](const Picture& picture, const Picture& reference) {
        return compare(*picture.image, *reference.image);
      },
      py::arg("picture"), py::arg("reference"), py::call_guard<py::gil_scoped_release>());
  module.def("merge", merged, py::arg("checkpoints"), py::arg("layers"));
  module.def(
      "display_views",
      [](const std::string& config_file) { return display_views(display({}, 0, config_file)); }, config);
  module.attr("layers_for_denoising") = layers_for_denoising;
}

}  // namespace vernier::python
