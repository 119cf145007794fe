// SPDX-License-Identifier: Apache-2.0
#include "scene/import/specular_glossiness.h"

#include <cmath>

namespace vernier {

std::shared_ptr<const Image8> roughness_of(const Image8& source, float factor) {
  auto roughness = std::make_shared<Image8>(source.width, source.height, 3);
  const bool has_alpha = source.channels == 2 || source.channels == 4;
  for (int y = 0; y < source.height; ++y)
    for (int x = 0; x < source.width; ++x) {
      const uint8_t* texel = source.pixel(x, y);
      const float glossiness = factor * (has_alpha ? float(texel[source.channels - 1]) : 255.f);
      roughness->pixel(x, y)[1] = uint8_t(std::lround(255 - glossiness));
    }
  return roughness;
}

}  // namespace vernier
