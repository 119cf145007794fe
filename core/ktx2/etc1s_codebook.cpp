// SPDX-License-Identifier: Apache-2.0
#include "core/ktx2/etc1s_codebook.h"

#include <algorithm>

#include "vernier/error.h"

namespace vernier::ktx2 {
namespace {

constexpr uint32_t channel_levels = 32;
constexpr uint32_t intensity_tables = 8;

/// What is added to a colour's channels (Khronos Data Format 1.3, table "ETC1 intensity modifiers").
constexpr std::array<std::array<int, 4>, intensity_tables> intensities{{{-8, -2, 2, 8},
                                                                        {-17, -5, 5, 17},
                                                                        {-29, -9, 9, 29},
                                                                        {-42, -13, 13, 42},
                                                                        {-60, -18, 18, 60},
                                                                        {-80, -24, 24, 80},
                                                                        {-106, -33, 33, 106},
                                                                        {-183, -47, 47, 183}}};

Palette palette_of(const std::array<uint32_t, 3>& color, uint32_t intensity) {
  Palette palette;
  for (size_t i = 0; i < 4; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const int base = int(color[c] << 3 | color[c] >> 2);
      palette[i][c] = uint8_t(std::clamp(base + intensities[intensity][i], 0, 255));
    }
    palette[i][3] = 255;
  }
  return palette;
}

void check(const BitReader& bits, const char* codebook) {
  if (bits.failed())
    throw Error(ErrorKind::input,
                std::string("KTX2: the codebook of ") + codebook + " is broken; the file is damaged");
}

}  // namespace

std::vector<Palette> read_palettes(std::span<const uint8_t> bytes, size_t count) {
  BitReader bits(bytes);
  // By how bright the channel was before.
  std::array<HuffmanTable, 3> channel_changes;
  for (HuffmanTable& table : channel_changes) table = HuffmanTable::read(bits);
  const HuffmanTable intensity_changes = HuffmanTable::read(bits);
  const bool is_gray = bits.read(1) != 0;
  const auto next_channel = [&](uint32_t previous) {
    const size_t range = previous <= 9 ? 0 : previous <= 21 ? 1 : 2;
    return (previous + channel_changes[range].decode(bits)) % channel_levels;
  };

  std::array<uint32_t, 3> color{16, 16, 16};
  uint32_t intensity = 0;
  std::vector<Palette> palettes(count);
  for (Palette& palette : palettes) {
    intensity = (intensity + intensity_changes.decode(bits)) % intensity_tables;
    color[0] = next_channel(color[0]);
    for (size_t c = 1; c < 3; ++c) color[c] = is_gray ? color[0] : next_channel(color[c]);
    palette = palette_of(color, intensity);
  }
  check(bits, "endpoints");
  return palettes;
}

std::vector<Selectors> read_selectors(std::span<const uint8_t> bytes, size_t count) {
  BitReader bits(bytes);
  if (bits.read(2) != 0) bits.fail();
  const bool is_raw = bits.read(1) != 0;
  HuffmanTable changes;
  if (!is_raw) changes = HuffmanTable::read(bits);
  std::vector<Selectors> selectors(count);
  for (size_t i = 0; i < count; ++i)
    for (size_t row = 0; row < 4; ++row)
      selectors[i][row] =
          uint8_t(is_raw || i == 0 ? bits.read(8) : changes.decode(bits) ^ selectors[i - 1][row]);
  check(bits, "selectors");
  return selectors;
}

}  // namespace vernier::ktx2
