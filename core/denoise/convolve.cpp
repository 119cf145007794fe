// SPDX-License-Identifier: Apache-2.0
#include "core/denoise/convolve.h"

#include "core/base/parallel.h"

namespace vernier {
namespace {

// One row with `radius` copies of its first and last pixel beside it.
void pad_row(const Image& image, int y, int radius, std::vector<float>& padded) {
  const size_t channels = size_t(image.channels);
  const float* row = image.pixel(0, y);
  const float* last = row + (size_t(image.width) - 1) * channels;
  padded.clear();
  for (int i = 0; i < radius; ++i) padded.insert(padded.end(), row, row + channels);
  padded.insert(padded.end(), row, last + channels);
  for (int i = 0; i < radius; ++i) padded.insert(padded.end(), last, last + channels);
}

}  // namespace

Image convolve(const Image& image, std::span<const float> horizontal, std::span<const float> vertical) {
  if (image.empty()) return Image(image.width, image.height, image.channels);
  const size_t row_size = size_t(image.width) * image.channels;
  Image across(image.width, image.height, image.channels);
  parallel_for(size_t(image.height), [&](size_t y) {
    std::vector<float> padded;
    pad_row(image, int(y), int(horizontal.size() / 2), padded);
    float* out = across.pixel(0, int(y));
    for (size_t k = 0; k < horizontal.size(); ++k) {
      const float* in = &padded[k * size_t(image.channels)];
      for (size_t i = 0; i < row_size; ++i) out[i] += horizontal[k] * in[i];
    }
  });
  Image result(image.width, image.height, image.channels);
  const int radius = int(vertical.size() / 2);
  parallel_for(size_t(image.height), [&](size_t y) {
    float* out = result.pixel(0, int(y));
    for (size_t k = 0; k < vertical.size(); ++k) {
      const float* in = across.pixel(0, std::clamp(int(y) + int(k) - radius, 0, image.height - 1));
      for (size_t i = 0; i < row_size; ++i) out[i] += vertical[k] * in[i];
    }
  });
  return result;
}

}  // namespace vernier
