// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/ktx2/bit_reader.h"

namespace vernier::ktx2 {

/// A canonical Huffman code as Deflate has it (RFC 1951, 3.2.2), with codes of up to 16 bits.
class HuffmanTable {
 public:
  HuffmanTable() = default;

  /// Reads a table as BasisLZ compresses it (KTX 2.0, "Compressed Huffman Tables"). Throws Error(input).
  static HuffmanTable read(BitReader& bits);

  /// The next symbol; 0, and the reader has failed, where the bits are no symbol's code.
  uint32_t decode(BitReader& bits) const {
    const uint32_t window = bits.peek();
    const Entry entry = short_codes_[window & (short_codes_.size() - 1)];
    if (entry.length == 0) return decode_long(window, bits);
    bits.skip(entry.length);
    return entry.symbol;
  }

 private:
  static constexpr int longest_code = 16;
  static constexpr int short_bits = 10;

  struct Entry {
    uint16_t symbol = 0;
    uint8_t length = 0;  ///< 0: a longer code, or none
  };

  /// From the length of each symbol's code, 0: the symbol does not occur. Throws Error(input).
  explicit HuffmanTable(std::span<const uint8_t> lengths);
  uint32_t decode_long(uint32_t window, BitReader& bits) const;

  /// By the next bits of the stream.
  std::array<Entry, size_t{1} << short_bits> short_codes_{};
  std::vector<uint16_t> symbols_;  ///< by their codes
  /// By length: how many codes there are.
  std::array<uint32_t, longest_code + 1> counts_{};
};

}  // namespace vernier::ktx2
