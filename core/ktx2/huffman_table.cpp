// SPDX-License-Identifier: Apache-2.0
#include "core/ktx2/huffman_table.h"

#include <algorithm>

#include "vernier/error.h"

namespace vernier::ktx2 {
namespace {

Error broken_table(const char* how) {
  return Error(ErrorKind::input, std::string("KTX2: a Huffman table ") + how + "; the file is damaged");
}

uint32_t reversed(uint32_t code, int length) {
  uint32_t result = 0;
  for (int i = 0; i < length; ++i) result |= (code >> i & 1) << (length - 1 - i);
  return result;
}

/// What follows a symbol of the code of lengths: how often a length is repeated, and which.
struct Run {
  int extra_bits;
  uint32_t least;
  bool of_zeros;
};
constexpr uint32_t first_run_symbol = 17;
constexpr std::array<Run, 4> runs{{{3, 3, true}, {7, 11, true}, {2, 3, false}, {7, 7, false}}};

/// Reads `count` code lengths, themselves coded by `code`.
std::vector<uint8_t> read_lengths(const HuffmanTable& code, size_t count, BitReader& bits) {
  std::vector<uint8_t> lengths;
  lengths.reserve(count);
  while (lengths.size() < count) {
    const uint32_t symbol = code.decode(bits);
    if (bits.failed()) throw broken_table("is cut off");
    if (symbol < first_run_symbol) {
      lengths.push_back(uint8_t(symbol));
      continue;
    }
    const Run& run = runs[symbol - first_run_symbol];
    const size_t repeats = run.least + bits.read(run.extra_bits);
    if (!run.of_zeros && (lengths.empty() || lengths.back() == 0))
      throw broken_table("repeats a code length where there is none");
    if (repeats > count - lengths.size()) throw broken_table("has more code lengths than symbols");
    lengths.insert(lengths.end(), repeats, run.of_zeros ? uint8_t{0} : lengths.back());
  }
  return lengths;
}

}  // namespace

HuffmanTable HuffmanTable::read(BitReader& bits) {
  constexpr std::array<uint8_t, 21> order{17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                          11, 4,  12, 3,  13, 2, 14, 1, 15, 16};
  const size_t symbols = bits.read(14);
  if (symbols == 0) return {};
  const size_t sent = bits.read(5);
  if (sent < 1 || sent > order.size()) throw broken_table("has a code of lengths of an impossible size");
  std::array<uint8_t, order.size()> lengths{};
  for (size_t i = 0; i < sent; ++i) lengths[order[i]] = uint8_t(bits.read(3));
  return HuffmanTable(read_lengths(HuffmanTable(lengths), symbols, bits));
}

HuffmanTable::HuffmanTable(std::span<const uint8_t> lengths) {
  for (const uint8_t length : lengths) ++counts_[length];
  counts_[0] = 0;
  std::array<uint32_t, longest_code + 2> next_code{}, next_place{};
  uint32_t unused = 1;  // codes of the length at hand that are left
  for (size_t length = 1; length <= longest_code; ++length) {
    unused = 2 * unused;
    if (counts_[length] > unused) throw broken_table("has too many codes");
    unused -= counts_[length];
    next_code[length + 1] = (next_code[length] + counts_[length]) << 1;
    next_place[length + 1] = next_place[length] + counts_[length];
  }
  const uint32_t used = next_place.back();
  if (unused > 0 && used > 1) throw broken_table("has codes without a symbol");
  symbols_.resize(used);
  for (size_t symbol = 0; symbol < lengths.size(); ++symbol) {
    const int length = lengths[symbol];
    if (length == 0) continue;
    symbols_[next_place[size_t(length)]++] = uint16_t(symbol);
    const uint32_t first = reversed(next_code[size_t(length)]++, length);
    if (length > short_bits) continue;
    for (size_t at = first; at < short_codes_.size(); at += size_t{1} << length)
      short_codes_[at] = {uint16_t(symbol), uint8_t(length)};
  }
}

uint32_t HuffmanTable::decode_long(uint32_t window, BitReader& bits) const {
  uint32_t code = 0, first = 0, place = 0;
  for (int length = 1; length <= longest_code; ++length) {
    const uint32_t count = counts_[size_t(length)];
    code = code << 1 | (window >> (length - 1) & 1);
    if (code - first < count) {
      bits.skip(length);
      return symbols_[place + code - first];
    }
    place += count;
    first = (first + count) << 1;
  }
  bits.fail();
  return 0;
}

}  // namespace vernier::ktx2
