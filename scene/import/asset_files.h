// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace vernier {

/// Owned bytes that start out uninitialised.
struct Bytes {
  std::unique_ptr<uint8_t[]> data;
  size_t size = 0;

  Bytes() = default;
  explicit Bytes(size_t count) : data(std::make_unique_for_overwrite<uint8_t[]>(count)), size(count) {}
  std::span<const uint8_t> span() const { return {data.get(), size}; }
};

/// What a URI refers to.
struct AssetContent {
  Bytes bytes;
  std::string problem;  ///< why there are no bytes: "'a.png' is missing: ..."; empty: there are
  std::string remark;   ///< what a user should know all the same; empty: nothing
};

/// Reads the scene file and what its URIs refer to, all of it regular files, and all of it inside the scene
/// file's folder unless `allow_outside` is given. A scene called "-" comes from standard input, and is taken
/// for a file in the current folder; one that is in memory lies in no folder and refers to no files. Callable
/// from many threads.
class AssetFiles {
 public:
  /// Throws Error(input) when the scene file's folder cannot be read.
  explicit AssetFiles(std::string scene_path, bool allow_outside = false);
  /// A scene file in memory, which must last until it was read; `name` is what errors call it.
  AssetFiles(std::string name, std::span<const uint8_t> scene)
      : scene_path_(std::move(name)), in_memory_(scene) {}

  const std::string& scene_path() const { return scene_path_; }
  /// Throws Error(input).
  Bytes read_scene() const;

  /// Content of a data URI or of a relative, percent-encoded reference. `place` is the JSON pointer of the
  /// URI. Throws Error(input) on a reference that is not to be followed, whether or not there is a file.
  AssetContent read_uri(const std::string& uri, const std::string& place) const;

 private:
  AssetContent read_reference(const std::string& uri, const std::string& place) const;

  static constexpr const char* standard_input = "-";

  std::string scene_path_;
  std::optional<std::span<const uint8_t>> in_memory_;  ///< none: it is a file
  std::string folder_;                                 ///< canonical
  bool allow_outside_ = false;
};

}  // namespace vernier
