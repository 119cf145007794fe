#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace vernier {

/// Owned bytes that start out uninitialised.
struct Bytes {
  std::unique_ptr<uint8_t[]> data;
  size_t size = 0;

  Bytes() = default;
  explicit Bytes(size_t count) : data(std::make_unique_for_overwrite<uint8_t[]>(count)), size(count) {}
  std::span<const uint8_t> span() const { return {data.get(), size}; }
};

/// Reads the scene file and what its URIs refer to, all of it regular files inside the scene file's folder.
/// Callable from many threads. Throws Error(input).
class AssetFiles {
 public:
  explicit AssetFiles(std::string scene_path);

  const std::string& scene_path() const { return scene_path_; }
  Bytes read_scene() const;

  /// Bytes of a data URI or of a relative, percent-encoded reference. `place` is the JSON pointer of the URI.
  Bytes read_uri(const std::string& uri, const std::string& place) const;

 private:
  Bytes read_relative(const std::string& uri, const std::string& place) const;

  std::string scene_path_;
  std::string folder_;  ///< canonical
};

}  // namespace vernier
