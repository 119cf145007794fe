// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "vernier/math.h"

namespace vernier {

/// Owen-scrambled Sobol' numbers as a pure function of (pixel, sample index, dimension, seed).
///
/// Dimensions come in blocks: one for the camera, one for each bounce. Within a block the numbers are one
/// Sobol' point of up to eight dimensions, Owen-scrambled; between blocks the point order is shuffled by a
/// nested uniform permutation (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4)), so any run of
/// 2^k samples starting at a multiple of 2^k is stratified in every block. A path that ends early or skips a
/// draw shifts nothing: each draw has a fixed place.
class Sampler {
 public:
  /// `stream` names the pixel; samples of one stream and seed are stratified against each other, others
  /// independent.
  Sampler(uint32_t stream, uint32_t index, uint64_t seed);

  /// Moves to the first dimension of block `block`.
  void start_block(uint32_t block);
  /// The next number, or the next two, of the block, in [0, 1). At most eight numbers a block.
  float next1() { return float(next_digits() >> 8) * 0x1p-24f; }
  Vec2f next2() {
    const float x = next1();
    const float y = next1();
    return {x, y};
  }
  /// The same with 53 binary digits, for choices of which some are very improbable. Those after the 32 of the
  /// Sobol' point are random, as all digits of an Owen scramble are from where the points no longer differ.
  double next1_fine();
  Vec2d next2_fine() {
    const double x = next1_fine();
    const double y = next1_fine();
    return {x, y};
  }

 private:
  static constexpr uint32_t lanes = 4;  ///< dimensions made at once
  void make_lanes();
  uint32_t next_digits() {
    if (dimension_ % lanes == 0) make_lanes();
    return points_[dimension_++ % lanes];
  }

  uint32_t stream_hash_;
  uint32_t reversed_index_;
  uint32_t block_hash_ = 0;
  uint32_t shuffled_ = 0;
  uint32_t dimension_ = 0;
  std::array<uint32_t, lanes> points_;  ///< of the lanes that dimension_ is among; binary digits
};

/// 64 to 32 bits, every input bit affecting every output bit (the finaliser of SplitMix64, Steele et al.
/// 2014).
inline uint32_t mix_bits(uint64_t v) {
  v ^= v >> 30;
  v *= 0xbf58476d1ce4e5b9ull;
  v ^= v >> 27;
  v *= 0x94d049bb133111ebull;
  return static_cast<uint32_t>((v ^ (v >> 31)) >> 32);
}

inline double Sampler::next1_fine() {
  const uint64_t digits = next_digits();
  // The digits are well mixed already: a product spreads them and the block over those that it adds.
  const uint64_t further = ((uint64_t(block_hash_ + dimension_) << 32) ^ digits) * 0x9e3779b97f4a7c15ull;
  return double((digits << 21) | (further >> 43)) * 0x1p-53;
}

}  // namespace vernier
