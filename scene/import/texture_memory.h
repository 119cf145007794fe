// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "materials/texture_pixels.h"
#include "vernier/scene.h"

namespace vernier {

/// Where decoded textures are: in memory or, where a limit is too small for them, in a file.
class TextureMemory {
 public:
  /// From now on. `scene_bytes`: that all else of the scene will take and does not yet.
  void limit(const MemoryLimit& limit, uint64_t scene_bytes) {
    limit_ = limit;
    scene_bytes_ = scene_bytes;
  }
  bool is_limited() const { return limit_.bytes > 0; }

  /// Makes room for as many bytes of textures: if there is too little, all that is kept from now on goes to a
  /// file, and a notice tells. Throws Error(output) where no such file can be made.
  void make_room(uint64_t bytes, std::vector<Notice>& notices);

  /// Throws Error(output).
  TexturePixels keep(const PixelsInMemory& pixels) const { return in_file(pixels, file_); }

  /// Calls decode(i) for i in [0, count), of which each brings bytes(i) of texels: as many at once, in
  /// parallel, as the limit has room for, in any order. Throws what the lowest of those at once throws.
  void for_each_that_fits(size_t count, const std::function<uint64_t(size_t)>& bytes,
                          const std::function<void(size_t)>& decode) const;

 private:
  std::shared_ptr<PagedFile> file_;  ///< null: memory
  MemoryLimit limit_;
  uint64_t scene_bytes_ = 0;
};

}  // namespace vernier
