// SPDX-License-Identifier: Apache-2.0
#include "tests/oidn/double.h"

#include <map>

namespace {

vernier::test::OidnRecord record;

struct Values {
  float* first;
  size_t count;
};

}  // namespace

struct OidnDevice {};
struct OidnFilter {
  std::map<std::string, Values> images;
};

// The names are the library's.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" {

vernier::test::OidnRecord* vernier_oidn_record() { return &record; }

OidnDevice* oidnNewDevice(int type) {
  record(type == 1 ? "new CPU device" : "new device of another type");
  return record.pending ? nullptr : new OidnDevice;
}
void oidnReleaseDevice(OidnDevice* device) {
  record("release device");
  delete device;
}
void oidnSetDeviceInt(OidnDevice*, const char* name, int value) {
  record(std::string(name) + " " + std::to_string(value));
}
void oidnSetDeviceBool(OidnDevice*, const char* name, bool value) {
  record(std::string(name) + (value ? " on" : " off"));
}
void oidnCommitDevice(OidnDevice*) { record("commit device"); }
int oidnGetDeviceError(OidnDevice*, const char** message) {
  const int error = record.pending;
  record.pending = 0;
  *message = error ? "the double fails" : nullptr;
  return error;
}

OidnFilter* oidnNewFilter(OidnDevice*, const char* type) {
  record(std::string("new filter ") + type);
  return record.pending ? nullptr : new OidnFilter;
}
void oidnReleaseFilter(OidnFilter* filter) {
  record("release filter");
  delete filter;
}
void oidnSetSharedFilterImage(OidnFilter* filter, const char* name, void* pixels, int format, size_t width,
                              size_t height, size_t offset, size_t pixel_stride, size_t row_stride) {
  record(std::string("image ") + name + " " + std::to_string(width) + "x" + std::to_string(height) +
         (format == 3 ? " float3" : " of another format") +
         (offset || pixel_stride || row_stride ? " with gaps" : ""));
  filter->images[name] = {static_cast<float*>(pixels), 3 * width * height};
}
void oidnSetFilterBool(OidnFilter*, const char* name, bool value) {
  record(std::string(name) + (value ? " on" : " off"));
}
void oidnCommitFilter(OidnFilter*) { record("commit filter"); }
void oidnExecuteFilter(OidnFilter* filter) {
  record("execute");
  const Values color = filter->images.at("color"), output = filter->images.at("output");
  for (size_t i = 0; i < output.count; ++i) output.first[i] = color.first[i] / 2;
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
