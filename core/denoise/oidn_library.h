// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace vernier {

/// Open Image Denoise 2 (Intel), loaded when it is first asked for, so that neither building nor running
/// needs it: the functions of its C interface that are used, as its API documentation declares them.
struct OidnLibrary {
  using Device = struct OidnDevice*;
  using Filter = struct OidnFilter*;
  enum class DeviceType : int { cpu = 1 };
  enum class Format : int { float3 = 3 };
  enum class Result : int { none = 0, out_of_memory = 4 };

  std::string path;  ///< the file that was loaded

  Device (*new_device)(DeviceType type);
  void (*release_device)(Device device);
  void (*set_device_bool)(Device device, const char* name, bool value);
  void (*set_device_int)(Device device, const char* name, int value);
  void (*commit_device)(Device device);
  /// The first error since the last call, which forgets it; of a null device the reason why it is null.
  Result (*get_device_error)(Device device, const char** message);
  Filter (*new_filter)(Device device, const char* type);
  void (*release_filter)(Filter filter);
  void (*set_shared_filter_image)(Filter filter, const char* name, void* pixels, Format format, size_t width,
                                  size_t height, size_t offset, size_t pixel_stride, size_t row_stride);
  void (*set_filter_bool)(Filter filter, const char* name, bool value);
  void (*commit_filter)(Filter filter);
  void (*execute_filter)(Filter filter);

  /// The library of this process, or null: $VERNIER_OIDN, its file or folder, where that is set (empty:
  /// none); else what the system's loader finds; else the Python package pyoidn of $VIRTUAL_ENV,
  /// $CONDA_PREFIX,
  /// ~/.local, /usr/local or /usr. It is looked for once.
  static const OidnLibrary* find();

  /// Whether $VERNIER_OIDN names one, so that another filter in its place would be a mistake.
  static bool is_named();

  /// Why find() gives null, and what helps: a sentence's end, for messages.
  static const std::string& why_not_found();
};

}  // namespace vernier
