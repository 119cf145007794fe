// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/math/simd.h"
#include "scene/lights/light_bounds.h"

namespace vernier {

/// Up to eight lights or groups of lights, laid out so that a point weighs all of them at once.
class alignas(64) LightNode {
 public:
  static constexpr int width = 8;

  void set(int slot, const LightBounds& bounds);

  /// Upper estimates, up to a constant, of the light that reaches the receiver from each slot; zero only
  /// where none can, and for slots that are not set. Sphere, cone and horizon bounds as in Conty Estevez and
  /// Kulla 2018, eq. 3.
  Float8 importance(const LightReceiver& receiver) const;

  /// By slot: a light, or a node when `leaf` lacks its bit.
  std::array<uint32_t, width> child{};
  unsigned leaf = 0;
  uint32_t parent = 0, slot_in_parent = 0;

 private:
  Float8 center_x_{}, center_y_{}, center_z_{}, radius2_{};  ///< of the sphere about the box
  Float8 axis_x_{}, axis_y_{}, axis_z_{};
  Float8 cos_spread_{}, sin_spread_{}, power_{};
  Float8 cos_emission_ = Float8{} + 2;  ///< of slots that are not set more than any cosine
  Float8 inside_{};                     ///< importance to receivers within the sphere
  Mask8 two_sided_{};
};

}  // namespace vernier
