// SPDX-License-Identifier: Apache-2.0
#include "core/ktx2/uastc.h"

#include "core/ktx2/level.h"
#include "core/ktx2/texels.h"
#include "core/ktx2/uastc_block.h"
#include "vernier/error.h"

namespace vernier::ktx2 {

void decode_uastc(const Container& container, Texture& texture) {
  const size_t columns = (size_t{texture.width} + 3) / 4, rows = (size_t{texture.height} + 3) / 4;
  const Level level(container, columns * rows * uastc_block_size);
  std::span<const uint8_t> blocks = level.bytes();
  for (size_t y = 0; y < rows; ++y)
    for (size_t x = 0; x < columns; ++x) {
      const auto texels = decode_uastc_block(blocks.first<uastc_block_size>());
      if (!texels)
        throw Error(ErrorKind::input, "KTX2: block " + std::to_string(x) + " of row " + std::to_string(y) +
                                          " is of no mode that there is; the file is damaged");
      const BlockPlace place(texture, x, y);
      for (size_t row = 0; row < place.rows(); ++row) place.write(row, (*texels)[row]);
      blocks = blocks.subspan(uastc_block_size);
    }
}

}  // namespace vernier::ktx2
