// SPDX-License-Identifier: Apache-2.0
#include "core/ktx2/uastc_block.h"

#include "core/ktx2/little_endian.h"
#include "core/ktx2/uastc_tables.h"

namespace vernier::ktx2 {
namespace {

constexpr size_t texel_count = 16;

/// The 128 bits of a block.
class BlockBits {
 public:
  explicit BlockBits(std::span<const uint8_t, uastc_block_size> block)
      : low_(read_number<uint64_t>(block, 0)), high_(read_number<uint64_t>(block, 8)) {}

  /// Up to 32 bits that begin at `at`.
  uint32_t get(int at, int count) const {
    const uint64_t shifted = at >= 64 ? high_ >> (at - 64) : at == 0 ? low_ : low_ >> at | high_ << (64 - at);
    return uint32_t(shifted & ((uint64_t{1} << count) - 1));
  }

 private:
  uint64_t low_, high_;
};

constexpr std::array<uint8_t, 128> make_mode_table() {
  std::array<uint8_t, 128> modes{};
  for (size_t mode = 0; mode < mode_codes.size(); ++mode)
    for (size_t bits = mode_codes[mode].code; bits < modes.size();
         bits += size_t{1} << mode_codes[mode].length)
      modes[bits] = uint8_t(mode);
  return modes;
}
constexpr std::array<uint8_t, 128> mode_table = make_mode_table();

/// The subset of each texel; empty for a pattern that does not exist.
std::optional<std::array<uint8_t, texel_count>> subsets_of(size_t mode, size_t pattern) {
  ThreeSubsets masks{};
  if (uastc_modes[mode].subsets == 3) {
    if (pattern >= three_subsets.size()) return std::nullopt;
    masks = three_subsets[pattern];
  } else if (uastc_modes[mode].subsets == 2) {
    const std::span<const uint16_t> patterns =
        mode == own_patterns_mode ? std::span<const uint16_t>(own_two_subsets) : two_subsets;
    if (pattern >= patterns.size()) return std::nullopt;
    masks.second = patterns[pattern];
  }
  std::array<uint8_t, texel_count> subsets;
  for (size_t i = 0; i < texel_count; ++i)
    subsets[i] = uint8_t((masks.second >> i & 1) + 2 * (masks.third >> i & 1));
  return subsets;
}

/// An endpoint as a number of 8 bits (Khronos Data Format 1.3, 23.13, "Endpoint Unquantization"): `digit` is
/// above the `bits` of the value.
constexpr uint8_t unquantized(const EndpointRange& range, uint32_t value, uint32_t digit) {
  if (range.base == 1) {
    value <<= 8 - range.bits;
    return uint8_t(value | value >> range.bits);
  }
  uint32_t spread = 0, step = 0;  // B and C of the specification
  const uint32_t upper = value >> 1;
  if (range.base == 3 && range.bits == 2) spread = upper * 0x116, step = 93;
  if (range.base == 3 && range.bits == 4) spread = upper << 6 | upper, step = 22;
  if (range.base == 3 && range.bits == 6) spread = upper << 4 | upper >> 4, step = 5;
  if (range.base == 5 && range.bits == 3) spread = upper << 7 | upper << 1 | upper >> 1, step = 26;
  if (range.base == 5 && range.bits == 5) spread = upper << 5 | upper >> 3, step = 6;
  const uint32_t ones = value & 1 ? 0x1ff : 0;
  return uint8_t((ones & 0x80) | ((digit * step + spread) ^ ones) >> 2);
}

/// A weight as a number from 0 to 64: its bits are repeated to fill six.
constexpr uint32_t unquantized_weight(uint32_t weight, int bits) {
  uint32_t six = 0;
  for (int filled = 0; filled < 6; filled += bits)
    six |= filled + bits <= 6 ? weight << (6 - filled - bits) : weight >> (filled + bits - 6);
  return six + (six > 32 ? 1 : 0);
}

constexpr int largest_weight_bits = 5;
constexpr auto weight_tables = [] {
  std::array<std::array<uint8_t, 1 << largest_weight_bits>, largest_weight_bits + 1> tables{};
  for (int bits = 1; bits <= largest_weight_bits; ++bits)
    for (uint32_t weight = 0; weight < 1u << bits; ++weight)
      tables[size_t(bits)][weight] = uint8_t(unquantized_weight(weight, bits));
  return tables;
}();

struct Endpoints {
  std::array<uint8_t, 4> low, high;
};

/// Digits are packed in groups: five of base 3 in eight bits, three of base 5 in seven, and a last group that
/// is not full in as few as it takes.
class DigitReader {
 public:
  DigitReader(const BlockBits& bits, const UastcMode& mode, int count)
      : bits_(bits), base_(uint32_t(mode.range.base)), at_(mode.digits), left_(count) {}

  uint32_t next() {
    if (base_ == 1) return 0;
    if (in_group_ == 0) {
      constexpr std::array<int, 6> group_bits{0, 2, 4, 5, 7, 8};
      in_group_ = std::min(left_, base_ == 3 ? 5 : 3);
      const int count = base_ == 3 ? group_bits[size_t(in_group_)] : 7;
      group_ = bits_.get(at_, count);
      at_ += count;
    }
    const uint32_t digit = group_ % base_;
    group_ /= base_;
    --in_group_;
    --left_;
    return digit;
  }

 private:
  const BlockBits& bits_;
  uint32_t base_;
  int at_;
  int left_;
  int in_group_ = 0;
  uint32_t group_ = 0;
};

std::array<Endpoints, 3> read_endpoints(const BlockBits& bits, const UastcMode& mode) {
  const int channels = mode.colors == rgb ? 3 : mode.colors == rgba ? 4 : 2;
  DigitReader digits(bits, mode, 2 * channels * mode.subsets);
  int at = mode.endpoints;
  const auto next = [&] {
    const uint32_t value = bits.get(at, mode.range.bits);
    at += mode.range.bits;
    return unquantized(mode.range, value, digits.next());
  };
  std::array<Endpoints, 3> endpoints{};
  for (int subset = 0; subset < mode.subsets; ++subset) {
    auto& [low, high] = endpoints[size_t(subset)];
    low[3] = high[3] = 255;
    if (mode.colors == luminance_alpha) {
      low[0] = low[1] = low[2] = next();
      high[0] = high[1] = high[2] = next();
      low[3] = next();
      high[3] = next();
      continue;
    }
    for (size_t c = 0; c < size_t(channels); ++c) {
      low[c] = next();
      high[c] = next();
    }
  }
  return endpoints;
}

/// Both ends are widened to sixteen bits, of which the upper eight are kept (Khronos Data Format 1.3, 23.19,
/// "Weight Application").
uint8_t interpolate(uint32_t low, uint32_t high, uint32_t weight) {
  return uint8_t((257 * (low * (64 - weight) + high * weight) + 32) >> 14);
}

/// The channel that has weights of its own.
size_t channel_of_second_plane(const BlockBits& bits, const UastcMode& mode) {
  return mode.colors == luminance_alpha ? 3 : bits.get(mode.selector, 2);
}

}  // namespace

std::optional<std::array<TexelRow, 4>> decode_uastc_block(std::span<const uint8_t, uastc_block_size> block) {
  const BlockBits bits(block);
  const size_t index = mode_table[bits.get(0, 7)];
  if (index == reserved_mode) return std::nullopt;
  const UastcMode& mode = uastc_modes[index];
  std::array<TexelRow, 4> texels;
  if (index == solid_mode) {
    const std::array<uint8_t, 4> color{
        uint8_t(bits.get(mode.endpoints, 8)), uint8_t(bits.get(mode.endpoints + 8, 8)),
        uint8_t(bits.get(mode.endpoints + 16, 8)), uint8_t(bits.get(mode.endpoints + 24, 8))};
    for (TexelRow& row : texels) row.fill(color);
    return texels;
  }
  const auto subsets = subsets_of(index, bits.get(mode.selector, mode.subsets == 3 ? 4 : 5));
  if (!subsets) return std::nullopt;
  const std::array<Endpoints, 3> endpoints = read_endpoints(bits, mode);
  const auto& weights = weight_tables[size_t(mode.weight_bits)];
  const bool has_two_planes = mode.planes == 2;
  const size_t second_channel = has_two_planes ? channel_of_second_plane(bits, mode) : 0;
  int at = mode.weights;
  uint32_t begun = 0;  // subsets whose first texel has been
  for (size_t i = 0; i < texel_count; ++i) {
    const uint32_t subset = (*subsets)[i];
    // The highest bit of the first weight of a subset is 0 and not stored.
    const int count = mode.weight_bits - int(~begun >> subset & 1);
    begun |= 1u << subset;
    const auto next_weight = [&] {
      const uint32_t weight = weights[bits.get(at, count)];
      at += count;
      return weight;
    };
    const auto& [low, high] = endpoints[subset];
    auto& texel = texels[i / 4][i % 4];
    const uint32_t weight = next_weight();
    for (size_t c = 0; c < 4; ++c) texel[c] = interpolate(low[c], high[c], weight);
    if (!has_two_planes) continue;
    texel[second_channel] = interpolate(low[second_channel], high[second_channel], next_weight());
  }
  return texels;
}

}  // namespace vernier::ktx2
