// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "core/base/parallel.h"
#include "core/denoise/denoise_filters.h"

namespace vernier {
namespace {

constexpr int radius = 2;
constexpr float same_surface = 1;  // squared feature distance

bool is_alike(const Image& features, int x, int y, int i, int j) {
  float distance = 0;
  for (int c = 0; c < features.channels; ++c)
    distance += square(features.pixel(x, y)[c] - features.pixel(i, j)[c]);
  return distance < same_surface;
}

float median(float* begin, float* end) {
  float* middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end);
  if ((end - begin) % 2 == 1) return *middle;
  return 0.5f * (*middle + *std::max_element(begin, middle));
}

}  // namespace

Image denoise_median(const NoisyImage& noisy) {
  const GuidedImage guided = prepare(noisy);
  const Image& color = guided.color;
  Image result(color.width, color.height, 3);
  parallel_for(size_t(color.height), [&](size_t row) {
    const int y = int(row);
    std::array<std::array<float, (2 * radius + 1) * (2 * radius + 1)>, 3> values;
    for (int x = 0; x < color.width; ++x) {
      size_t count = 0;
      for (int j = std::max(0, y - radius); j <= std::min(color.height - 1, y + radius); ++j)
        for (int i = std::max(0, x - radius); i <= std::min(color.width - 1, x + radius); ++i) {
          if (!is_alike(guided.features, x, y, i, j)) continue;
          for (size_t c = 0; c < 3; ++c) values[c][count] = color.pixel(i, j)[c];
          ++count;
        }
      for (size_t c = 0; c < 3; ++c)
        result.pixel(x, y)[c] = median(values[c].data(), values[c].data() + count);
    }
  });
  return modulate(keep_unexplained(std::move(result), guided), guided);
}

}  // namespace vernier
