// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

// A double of Open Image Denoise, as far as core/image/denoise_oidn.cpp uses it: it writes down what is asked
// of it, fails when told to, and its filter halves the colour.

namespace oidn {

enum class DeviceType { Default, CPU };
enum class Format { Undefined, Float3 };
enum class Error { None, Unknown, OutOfMemory };

/// What the double was asked, and how it is to answer.
struct Record {
  std::vector<std::string> calls;
  std::string fails_at;  ///< the call that fails; empty: none does
  Error failure = Error::Unknown;
  Error pending = Error::None;  ///< not asked for yet

  void operator()(const std::string& call) {
    calls.push_back(call);
    if (call == fails_at) pending = failure;
  }
};
inline Record record;

class FilterRef {
 public:
  explicit FilterRef(bool made) {
    if (made) images_ = {new Images, release};
  }
  void setImage(const char* name, void* pixels, Format format, size_t width, size_t height, size_t = 0,
                size_t = 0, size_t = 0) {
    record(std::string("image ") + name + " " + std::to_string(width) + "x" + std::to_string(height) +
           (format == Format::Float3 ? " float3" : " of another format"));
    (*images_)[name] = {static_cast<float*>(pixels), 3 * width * height};
  }
  void set(const char* name, bool value) { record(std::string(name) + (value ? " on" : " off")); }
  void commit() { record("commit filter"); }
  void execute() {
    record("execute");
    const Values color = images_->at("color"), output = images_->at("output");
    for (size_t i = 0; i < output.count; ++i) output.first[i] = color.first[i] / 2;
  }

 private:
  struct Values {
    float* first;
    size_t count;
  };
  using Images = std::map<std::string, Values>;
  static void release(Images* images) {
    delete images;
    record("release filter");
  }
  std::shared_ptr<Images> images_;
};

class DeviceRef {
 public:
  explicit DeviceRef(bool made) {
    if (made) handle_ = {new int, release};
  }
  explicit operator bool() const { return bool(handle_); }
  void set(const char* name, int value) { record(std::string(name) + " " + std::to_string(value)); }
  void set(const char* name, bool value) { record(std::string(name) + (value ? " on" : " off")); }
  void commit() { record("commit device"); }
  FilterRef newFilter(const char* type) const {
    record(std::string("new filter ") + type);
    return FilterRef(record.pending == Error::None);
  }
  Error getError(const char*& message) {
    const Error error = record.pending;
    record.pending = Error::None;
    if (error != Error::None) message = "the double fails";
    return error;
  }

 private:
  static void release(int* handle) {
    delete handle;
    record("release device");
  }
  std::shared_ptr<int> handle_;
};

inline DeviceRef newDevice(DeviceType type) {
  record(type == DeviceType::CPU ? "new CPU device" : "new device of another type");
  return DeviceRef(record.pending == Error::None);
}

}  // namespace oidn
