// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "core/base/parallel.h"
#include "core/denoise/denoise_filters.h"
#include "core/denoise/oidn_library.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using DevicePtr = std::unique_ptr<OidnDevice, void (*)(OidnLibrary::Device)>;
using FilterPtr = std::unique_ptr<OidnFilter, void (*)(OidnLibrary::Filter)>;

/// Throws the first error that happened on `device` since the last check; a null one tells why it is null.
void check(const OidnLibrary& oidn, OidnLibrary::Device device) {
  const char* message = nullptr;
  const OidnLibrary::Result result = oidn.get_device_error(device, &message);
  if (result == OidnLibrary::Result::none && device) return;
  throw Error(result == OidnLibrary::Result::out_of_memory ? ErrorKind::memory : ErrorKind::usage,
              fmt::format("Open Image Denoise: {}; other filters do without that library",
                          message ? message : "unknown error"));
}

/// On the processor, since graphics cards cannot read our memory, and on as many threads as we have. These
/// are not bound to cores: what runs on them later would stay there.
DevicePtr new_device(const OidnLibrary& oidn) {
  DevicePtr device(oidn.new_device(OidnLibrary::DeviceType::cpu), oidn.release_device);
  check(oidn, device.get());
  oidn.set_device_int(device.get(), "numThreads", int(thread_count()));
  oidn.set_device_bool(device.get(), "setAffinity", false);
  oidn.commit_device(device.get());
  check(oidn, device.get());
  return device;
}

}  // namespace

// A convolutional network, trained on path-traced pictures.
Image denoise_oidn(const NoisyImage& noisy) {
  const OidnLibrary* const oidn = OidnLibrary::find();
  if (!oidn) throw Error(ErrorKind::usage, "no filter 'oidn' here: " + OidnLibrary::why_not_found());
  NoisyImage input = made_finite(noisy);
  Image output(input.color.width, input.color.height, 3);
  const DevicePtr device = new_device(*oidn);
  const FilterPtr filter(oidn->new_filter(device.get(), "RT"), oidn->release_filter);
  check(*oidn, device.get());
  const auto set_image = [&](const char* name, Image& image) {
    oidn->set_shared_filter_image(filter.get(), name, image.values.data(), OidnLibrary::Format::float3,
                                  size_t(image.width), size_t(image.height), 0, 0, 0);
  };
  set_image("color", input.color);
  if (input.albedo) set_image("albedo", *input.albedo);
  // There is no network for normals without albedo.
  if (input.albedo && input.normal) set_image("normal", *input.normal);
  set_image("output", output);
  oidn->set_filter_bool(filter.get(), "hdr", true);
  oidn->commit_filter(filter.get());
  check(*oidn, device.get());
  oidn->execute_filter(filter.get());
  check(*oidn, device.get());
  return output;
}

}  // namespace vernier
