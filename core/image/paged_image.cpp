// SPDX-License-Identifier: Apache-2.0
#include "core/image/paged_image.h"

#include <algorithm>
#include <cstring>

namespace vernier {
namespace {

/// What `act` makes of the number of channels, as a constant.
template <typename Act>
auto with_channels(int channels, const Act& act) {
  switch (channels) {
    case 1:
      return act(std::integral_constant<int, 1>());
    case 2:
      return act(std::integral_constant<int, 2>());
    case 3:
      return act(std::integral_constant<int, 3>());
    default:
      return act(std::integral_constant<int, 4>());
  }
}

int blocks(int texels, int log_tile) { return ((texels - 1) >> (log_tile + 2)) + 1; }

}  // namespace

template <typename T>
template <int channels>
PagedFile::Part PagedImage<T>::add(const BasicImage<T>& image, PagedFile& file) {
  constexpr TileShape shape = tile_shape(channels * int(sizeof(T)));
  constexpr int tile_width = 1 << shape.log_width, tile_height = 1 << shape.log_height;
  constexpr size_t texel_bytes = channels * sizeof(T);
  const int across = blocks(image.width, shape.log_width), down = blocks(image.height, shape.log_height);
  return file.add(size_t(across) * size_t(down), [&](size_t block, std::span<std::byte> bytes) {
    const int left = int(block % size_t(across)) * 4 * tile_width;
    const int top = int(block / size_t(across)) * 4 * tile_height;
    std::byte* row = bytes.data();
    for (int tile = 0; tile < 16; ++tile)
      for (int y = 0; y < tile_height; ++y, row += size_t(tile_width) * texel_bytes) {
        const int x = left + (tile & 3) * tile_width, from = top + (tile >> 2) * tile_height + y;
        const int count = from < image.height ? std::clamp(image.width - x, 0, tile_width) : 0;
        if (count > 0) std::memcpy(row, image.pixel(x, from), size_t(count) * texel_bytes);
      }
    return size_t(row - bytes.data());
  });
}

template <typename T>
PagedImage<T>::PagedImage(const BasicImage<T>& image, std::shared_ptr<PagedFile> file)
    : width_(image.width),
      height_(image.height),
      channels_(image.channels),
      blocks_across_(blocks(image.width, tile_shape(image.channels * int(sizeof(T))).log_width)),
      file_(std::move(file)),
      part_(with_channels(image.channels, [&](auto count) { return add<count>(image, *file_); })) {}

template <typename T>
const T* PagedImage<T>::texel(int x, int y) const {
  return with_channels(channels_, [&](auto count) { return texel<count>(x, y); });
}

template <typename T>
BasicImage<T> PagedImage<T>::unpacked() const {
  BasicImage<T> image(width_, height_, channels_);
  with_channels(channels_, [&](auto count) {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) std::copy_n(texel<count>(x, y), int(count), image.pixel(x, y));
  });
  return image;
}

template class PagedImage<uint8_t>;
template class PagedImage<uint16_t>;

}  // namespace vernier
