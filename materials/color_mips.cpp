// SPDX-License-Identifier: Apache-2.0
#include "materials/color_mips.h"

#include <map>

#include "materials/material.h"
#include "materials/texture_pixels.h"

namespace vernier {

void ColorMips::make(std::span<const Material> materials) {
  std::call_once(once_, [&] { make_all(materials); });
}

void ColorMips::make_all(std::span<const Material> materials) {
  std::vector<std::array<std::unique_ptr<const MipPyramid>, 2>> pyramids(textures_.size());
  std::map<std::pair<TexturePixels, bool>, std::vector<TexturePixels>> of_pictures;
  size_t bytes = 0;
  for (const Material& material : materials)
    for (const auto& [index, by_alpha] : material.color_textures()) {
      const Texture& texture = textures_[size_t(index)];
      auto& pyramid = pyramids[size_t(index)][by_alpha];
      if (pyramid || !texture.has_mips()) continue;
      const auto [mips, is_new] = of_pictures.try_emplace({texture.pixels(), by_alpha});
      if (is_new) {
        mips->second = make_mips(texture.pixels(), by_alpha);
        for (const TexturePixels& mip : mips->second)
          if (!file_of(mip)) bytes += texel_bytes(mip);
      }
      pyramid = std::make_unique<MipPyramid>(texture, mips->second, by_alpha);
    }
  pyramids_ = std::move(pyramids);
  bytes_ = bytes;
}

}  // namespace vernier
