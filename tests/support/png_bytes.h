// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vernier::test {

/// A PNG file of exactly these samples, uncompressed: lets a test say what a decoder must return.
struct PngSource {
  uint32_t width = 1, height = 1;
  int bit_depth = 8;                        ///< 8 or 16
  int colour_type = 2;                      ///< 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA
  std::vector<uint8_t> samples = {};        ///< rows without filter bytes; 16-bit ones big endian
  std::vector<uint8_t> palette = {};        ///< colour type 3: RGB triples
  std::vector<uint8_t> palette_alpha = {};  ///< optional tRNS
};

std::vector<uint8_t> png_bytes(const PngSource& source);

/// A valid PNG header that claims this size, and no pixels to speak of.
std::vector<uint8_t> png_bomb(uint32_t width, uint32_t height);

}  // namespace vernier::test
