// SPDX-License-Identifier: Apache-2.0
#include "scene/import/specular_glossiness.h"

#include <cmath>
#include <limits>

namespace vernier {

namespace {

template <typename T>
std::shared_ptr<const BasicImage<T>> roughness_of(const BasicImage<T>& source, float factor) {
  constexpr float most = std::numeric_limits<T>::max();
  auto roughness = std::make_shared<BasicImage<T>>(source.width, source.height, 3);
  const bool has_alpha = source.channels == 2 || source.channels == 4;
  for (int y = 0; y < source.height; ++y)
    for (int x = 0; x < source.width; ++x) {
      const T* texel = source.pixel(x, y);
      const float glossiness = factor * (has_alpha ? float(texel[source.channels - 1]) : most);
      roughness->pixel(x, y)[1] = T(std::lround(most - glossiness));
    }
  return roughness;
}

}  // namespace

PixelsInMemory roughness_of(const PixelsInMemory& source, float factor) {
  return std::visit([&](const auto& image) { return PixelsInMemory(roughness_of(*image, factor)); }, source);
}

}  // namespace vernier
