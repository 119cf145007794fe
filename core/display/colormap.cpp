// SPDX-License-Identifier: Apache-2.0
#include "core/display/colormap.h"

#include <array>

namespace vernier {
namespace {

using Color = std::array<uint8_t, 3>;

constexpr std::array<Color, 17> magma{{{0, 0, 4},
                                       {10, 8, 34},
                                       {29, 17, 70},
                                       {54, 16, 106},
                                       {80, 18, 124},
                                       {105, 28, 129},
                                       {130, 38, 129},
                                       {156, 46, 127},
                                       {182, 55, 121},
                                       {207, 65, 112},
                                       {230, 81, 99},
                                       {245, 105, 92},
                                       {251, 135, 97},
                                       {254, 165, 113},
                                       {254, 195, 135},
                                       {253, 224, 162},
                                       {252, 253, 191}}};
constexpr Color not_a_number{0, 255, 0};

Color color_of(float value) {
  if (std::isnan(value)) return not_a_number;
  const float place = std::clamp(value, 0.f, 1.f) * float(magma.size() - 1);
  const size_t i = std::min(size_t(place), magma.size() - 2);
  Color color;
  for (size_t c = 0; c < 3; ++c)
    color[c] = uint8_t(std::lround(lerp(place - float(i), magma[i][c], magma[i + 1][c])));
  return color;
}

}  // namespace

Image8 colormap(const Image& map, float largest) {
  Image8 picture(map.width, map.height, 3);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const Color color = color_of(*map.pixel(x, y) / largest);
      std::copy(color.begin(), color.end(), picture.pixel(x, y));
    }
  return picture;
}

}  // namespace vernier
