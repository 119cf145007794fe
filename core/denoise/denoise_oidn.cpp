// SPDX-License-Identifier: Apache-2.0
#include <OpenImageDenoise/oidn.hpp>

#include <fmt/format.h>

#include "core/base/parallel.h"
#include "core/denoise/denoise_filters.h"
#include "vernier/error.h"

// The library's C++ interface, in calls that versions 1.4 and 2 share.

namespace vernier {
namespace {

/// Throws the first error that happened on `device` since the last check; a null one tells why it is null.
void check(oidn::DeviceRef& device) {
  const char* message = nullptr;
  const oidn::Error error = device.getError(message);
  if (error == oidn::Error::None && device) return;
  throw Error(error == oidn::Error::OutOfMemory ? ErrorKind::memory : ErrorKind::usage,
              fmt::format("Open Image Denoise: {}; other filters do without that library",
                          message ? message : "unknown error"));
}

/// On the processor, since graphics cards cannot read our memory, and on as many threads as we have. These
/// are not bound to cores: what runs on them later would stay there.
oidn::DeviceRef new_device() {
  oidn::DeviceRef device = oidn::newDevice(oidn::DeviceType::CPU);
  check(device);
  device.set("numThreads", int(thread_count()));
  device.set("setAffinity", false);
  device.commit();
  check(device);
  return device;
}

}  // namespace

// A convolutional network, trained on path-traced pictures.
Image denoise_oidn(const NoisyImage& noisy) {
  NoisyImage input = made_finite(noisy);
  Image output(input.color.width, input.color.height, 3);
  oidn::DeviceRef device = new_device();
  oidn::FilterRef filter = device.newFilter("RT");
  check(device);
  const auto set_image = [&](const char* name, Image& image) {
    filter.setImage(name, image.values.data(), oidn::Format::Float3, size_t(image.width),
                    size_t(image.height));
  };
  set_image("color", input.color);
  if (input.albedo) set_image("albedo", *input.albedo);
  // There is no network for normals without albedo.
  if (input.albedo && input.normal) set_image("normal", *input.normal);
  set_image("output", output);
  filter.set("hdr", true);
  filter.commit();
  check(device);
  filter.execute();
  check(device);
  return output;
}

}  // namespace vernier
