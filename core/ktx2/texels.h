// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstring>

#include "core/ktx2/ktx2.h"

namespace vernier::ktx2 {

/// A row of a block.
using TexelRow = std::array<std::array<uint8_t, 4>, 4>;

/// Where a block goes in the picture: what of it lies beyond the right and lower edges is left out.
class BlockPlace {
 public:
  BlockPlace(Texture& texture, size_t block_x, size_t block_y)
      : first_(texture.rgba.data() + (4 * block_y * texture.width + 4 * block_x) * 4),
        stride_(size_t{texture.width} * 4),
        columns_(std::min<size_t>(4, texture.width - 4 * block_x)),
        rows_(std::min<size_t>(4, texture.height - 4 * block_y)) {}

  size_t columns() const { return columns_; }
  size_t rows() const { return rows_; }
  /// The leftmost texel of a row, of four bytes each.
  uint8_t* row(size_t y) const { return first_ + y * stride_; }

  void write(size_t y, const TexelRow& texels) const {
    // A size that is known becomes one instruction.
    if (columns_ == 4)
      std::memcpy(row(y), texels.data(), sizeof(TexelRow));
    else
      std::memcpy(row(y), texels.data(), columns_ * 4);
  }

 private:
  uint8_t* first_;
  size_t stride_;
  size_t columns_, rows_;
};

}  // namespace vernier::ktx2
