// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/ktx2/huffman_table.h"

namespace vernier::ktx2 {

/// The four colours of an ETC1S block, RGBA with an alpha of 255, from the darkest.
using Palette = std::array<std::array<uint8_t, 4>, 4>;
/// Which of the four each texel has: a byte a row, the leftmost texel in the lowest two bits.
using Selectors = std::array<uint8_t, 4>;

/// The palettes that blocks choose from (KTX 2.0, "ETC1S Endpoint Codebooks"), with colours as ETC1 makes
/// them of five bits a channel and a table of intensities (Khronos Data Format 1.3, 21.1). Throws
/// Error(input).
std::vector<Palette> read_palettes(std::span<const uint8_t> bytes, size_t count);

/// The selectors that blocks choose from (KTX 2.0, "ETC1S Selector Codebooks"). Throws Error(input).
std::vector<Selectors> read_selectors(std::span<const uint8_t> bytes, size_t count);

}  // namespace vernier::ktx2
