// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/math/simd.h"
#include "scene/lights/light_bounds.h"

namespace vernier {

/// Up to eight lights or groups of lights, laid out so that a point weighs all of them at once. Four lines of
/// a cache, since what many lights cost is waiting for them: directions are kept in 16 bits, and angles that
/// bound are rounded so that they only grow.
class alignas(64) LightNode {
 public:
  static constexpr int width = 8;

  void set(int slot, const LightBounds& bounds);
  void set_light(int slot, uint32_t light);
  /// `down`: how many nodes after this one it lies.
  void set_node(int slot, uint32_t down) { child_[size_t(slot)] = down; }
  /// This is slot `slot` of the node that lies `up` nodes before.
  void set_parent(uint32_t up, int slot);

  /// Upper estimates, up to a constant, of the light that reaches the receiver from each slot; zero only
  /// where none can, and for slots that are not set. Sphere, cone and horizon bounds as in Conty Estevez and
  /// Kulla 2018, eq. 3.
  Float8 importance(const LightReceiver& receiver) const;

  /// Whether the slot is a light rather than a node.
  bool is_light(int slot) const { return leaf_ >> slot & 1; }
  /// The light, or how many nodes after this one its node lies.
  uint32_t child(int slot) const { return child_[size_t(slot)]; }
  /// How many nodes before this one its parent lies, 0: it is the root; and which slot of it this is.
  uint32_t to_parent() const { return to_parent_; }
  int slot_in_parent() const { return slot_in_parent_; }

 private:
  using Short8 = int16_t __attribute__((vector_size(16)));
  using UShort8 = uint16_t __attribute__((vector_size(16)));
  using Byte8 = int8_t __attribute__((vector_size(8)));

  Float8 center_x_{}, center_y_{}, center_z_{}, radius2_{};  ///< of the sphere about the box
  Short8 axis_x_{}, axis_y_{}, axis_z_{};                    ///< in parts of 2^15 - 1
  UShort8 half_sine_{};  ///< sine of half the spread, in parts of 2^16 - 1: resolves narrow cones, too
  UShort8 power_{};      ///< the upper half of a float; 0: a slot that is not set
  std::array<uint32_t, width> child_{};
  Byte8 cos_emission_{};  ///< in parts of 127
  uint32_t to_parent_ = 0;
  uint8_t slot_in_parent_ = 0, leaf_ = 0, two_sided_ = 0;
};
static_assert(sizeof(LightNode) == 256);

}  // namespace vernier
