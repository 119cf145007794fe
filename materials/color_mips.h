// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <span>

#include "materials/mip_pyramid.h"

namespace vernier {

class Material;

/// The textures of colors that materials read, for reading them over areas. Nothing until somebody asks.
class ColorMips {
 public:
  explicit ColorMips(std::span<const Texture> textures) : textures_(textures) {}

  /// For all that these read, on the first call alone; from many threads. find() belongs to those who have
  /// called it.
  void make(std::span<const Material> materials);

  /// Of a texture by its index, texels weighted by alpha or not; null: it is to be read at points.
  const MipPyramid* find(int texture, bool by_alpha) const {
    return pyramids_.empty() ? nullptr : pyramids_[size_t(texture)][by_alpha].get();
  }
  /// In memory beside the textures themselves, none of those that are in a file; 0 before make().
  size_t bytes() const { return bytes_; }

 private:
  void make_all(std::span<const Material> materials);

  std::span<const Texture> textures_;
  std::once_flag once_;
  std::vector<std::array<std::unique_ptr<const MipPyramid>, 2>> pyramids_;
  size_t bytes_ = 0;
};

}  // namespace vernier
