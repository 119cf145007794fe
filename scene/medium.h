// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "vernier/math.h"

namespace vernier {

/// What fills a part of space; the default is air.
struct Medium {
  Rgb absorption{0, 0, 0};  ///< per metre
  Rgb ior{1, 1, 1};         ///< index of refraction, by color channel
};

/// Fraction of light that is left after `distance` metres, which may be infinite (Beer-Lambert).
inline Rgb transmittance(const Medium& medium, float distance) {
  if (is_black(medium.absorption)) return {1, 1, 1};
  Rgb left;
  for (int c = 0; c < 3; ++c)
    left[c] = medium.absorption[c] > 0 ? std::exp(-medium.absorption[c] * distance) : 1;
  return left;
}

/// The volumes that a point lies in, by their numbers in the scene's VolumeSet. A larger number has priority:
/// where volumes overlap, its medium is the one that is there (Schmidt and Budge 2002, "Simple Nested
/// Dielectrics in Ray Traced Images"). A volume that is entered twice must be left twice.
class MediumStack {
 public:
  static constexpr uint32_t air = 0xffffffff;

  MediumStack() = default;
  /// Only what is there is copied: at most points that is nothing.
  MediumStack(const MediumStack& other) { *this = other; }
  MediumStack& operator=(const MediumStack& other) {
    size_ = other.size_;
    if (size_ > 0) volumes_ = other.volumes_;
    return *this;
  }

  bool empty() const { return size_ == 0; }
  /// The volume whose medium fills the point; `air` when it lies in none.
  uint32_t current() const { return size_ == 0 ? air : volumes_[size_ - 1]; }

  /// Beyond its capacity of nested volumes nothing is entered.
  void enter(uint32_t volume) {
    if (size_ == capacity) return;
    uint32_t i = size_++;
    for (; i > 0 && volumes_[i - 1] > volume; --i) volumes_[i] = volumes_[i - 1];
    volumes_[i] = volume;
  }
  /// Nothing happens where the point does not lie in it.
  void leave(uint32_t volume) {
    for (uint32_t i = 0; i < size_; ++i) {
      if (volumes_[i] != volume) continue;
      for (--size_; i < size_; ++i) volumes_[i] = volumes_[i + 1];
      return;
    }
  }

 private:
  static constexpr uint32_t capacity = 7;

  uint32_t size_ = 0;
  std::array<uint32_t, capacity> volumes_;  ///< by increasing priority
};

}  // namespace vernier
