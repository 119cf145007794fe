// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/base/paged_file.h"
#include "vernier/image.h"

namespace vernier {

/// How many texels, as powers of two, lie beside and below each other in a tile of a PagedImage, which is a
/// page of 4096 bytes or, for three channels, three quarters of one.
struct TileShape {
  int log_width, log_height;
};

constexpr TileShape tile_shape(int bytes_per_texel) {
  if (bytes_per_texel == 1) return {6, 6};
  if (bytes_per_texel == 2) return {6, 5};
  return {5, bytes_per_texel <= 4 ? 5 : 4};
}

/// A picture whose texels lie in a PagedFile, for reading a few of them at a time: in tiles of a page, of
/// which four by four make up a block, so that what is beside and below each other is read together.
template <typename T>
class PagedImage {
 public:
  /// Throws Error(output).
  PagedImage(const BasicImage<T>& image, std::shared_ptr<PagedFile> file);

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }
  const std::shared_ptr<PagedFile>& file() const { return file_; }

  /// One that is known to have this many channels.
  template <int channels>
  const T* texel(int x, int y) const {
    constexpr TileShape shape = tile_shape(channels * int(sizeof(T)));
    constexpr int across = (1 << shape.log_width) - 1, down = (1 << shape.log_height) - 1;
    const auto [block_x, block_y] = std::pair(x >> (shape.log_width + 2), y >> (shape.log_height + 2));
    const int tile = (y >> shape.log_height & 3) << 2 | (x >> shape.log_width & 3);
    const int in_block =
        tile << (shape.log_width + shape.log_height) | (y & down) << shape.log_width | (x & across);
    const size_t block = size_t(block_y) * size_t(blocks_across_) + size_t(block_x);
    return reinterpret_cast<const T*>(
        part_.at(block * PagedFile::block_bytes + size_t(in_block) * channels * sizeof(T)));
  }
  const T* texel(int x, int y) const;

  /// All of it, in memory.
  BasicImage<T> unpacked() const;

 private:
  template <int channels>
  static PagedFile::Part add(const BasicImage<T>& image, PagedFile& file);

  int width_, height_, channels_, blocks_across_;
  std::shared_ptr<PagedFile> file_;
  PagedFile::Part part_;
};

extern template class PagedImage<uint8_t>;
extern template class PagedImage<uint16_t>;

}  // namespace vernier
