// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "vernier/math.h"

namespace vernier {

/// What fills a part of space; the default is air.
struct Medium {
  Rgb extinction{0, 0, 0};  ///< per metre: what a ray loses, by absorption and scattering
  Rgb ior{1, 1, 1};         ///< index of refraction, by color channel
  Rgb scattering{0, 0, 0};  ///< per metre, of the extinction
  float anisotropy = 0;     ///< of the scattering: HenyeyGreenstein::g
  bool sees_lights = true;  ///< false: certainly no light gets straight to a point inside

  bool scatters() const { return !is_black(scattering); }
};

/// Fraction of light that is left after `distance` metres, which may be infinite (Beer-Lambert).
inline Rgb transmittance(const Medium& medium, float distance) {
  if (is_black(medium.extinction)) return {1, 1, 1};
  Rgb left;
  for (int c = 0; c < 3; ++c)
    left[c] = medium.extinction[c] > 0 ? std::exp(-medium.extinction[c] * distance) : 1;
  return left;
}

/// Where light that travels through a scattering medium is scattered first. The density of the distance is
/// the mean of those that each color channel would have for itself, so no channel is ever divided by a
/// density that is small for it alone (the balance heuristic over channels: Wilkie et al. 2014, "Hero
/// Wavelength Spectral Sampling", eq. 8).
class FreeFlight {
 public:
  /// Of light that may be needed in the channels of `throughput`, over `length` metres, which may be
  /// infinite.
  FreeFlight(const Medium& medium, const Rgb& throughput, float length);

  struct Sample {
    float distance;  ///< metres; beyond `length` when nothing scatters
    Rgb weight;      ///< what is left and scattered there, or left at the end, over the density
    bool is_scattered;
  };
  /// u in [0, 1).
  Sample sample(double u) const;
  /// Density of `distance`, below `length`.
  float pdf(float distance) const;
  /// Fraction of light that is left after `distance` and scattered per metre there.
  Rgb scattered(float distance) const { return transmittance(medium_, distance) * medium_.scattering; }

 private:
  const Medium& medium_;
  Rgb share_;  ///< of the samples, by channel
  float length_;
};

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
