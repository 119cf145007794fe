// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "scene/lights/light_group.h"
#include "scene/lights/sine.h"

namespace vernier {

/// What groups of lights cost in a tree, eight at once: power by half the area of the box and by the solid
/// angle that emission covers (Conty Estevez and Kulla 2018, eqs. 1 and 2).
template <int batches>
class LightCosts {
 public:
  void set(size_t i, const LightGroup& group) {
    Batch& batch = batches_[i / 8];
    const size_t lane = i % 8;
    const Float4 size = group.upper - group.lower, center = (group.axis_lower + group.axis_upper) * 0.5f,
                 half = (group.axis_upper - group.axis_lower) * 0.5f;
    for (size_t axis = 0; axis < 3; ++axis) {
      batch.size[axis][lane] = size[axis];
      batch.center[axis][lane] = center[axis];
      batch.half[axis][lane] = half[axis];
    }
    batch.cos_spread[lane] = group.cos_spread();
    batch.cos_emission[lane] = group.cos_emission;
    batch.power[lane] = group.two_sided ? 2 * group.power : group.power;
  }

  /// Of groups 8 i to 8 i + 7.
  Float8 of(size_t i) const {
    const Batch& b = batches_[i];
    const Float8 half_area = b.size[0] * b.size[1] + b.size[1] * b.size[2] + b.size[2] * b.size[0];
    return b.power * half_area * b.solid_angle();
  }

 private:
  struct Batch {
    std::array<Float8, 3> size{};            ///< of the box
    std::array<Float8, 3> center{}, half{};  ///< of the box about the axes
    Float8 cos_spread{}, cos_emission{}, power{};

    Float8 cos_of_axes() const;
    Float8 solid_angle() const;
  };

  /// To 7e-5 (Abramowitz and Stegun 1964, "Handbook of Mathematical Functions", 4.4.45).
  static Float8 arc_cosine(const Float8& x) {
    const Float8 positive = x < 0 ? -x : x;
    const Float8 angle =
        square_root(1 - positive) *
        (1.5707288f + positive * (-0.2121144f + positive * (0.0742610f - 0.0187293f * positive)));
    return x < 0 ? pi - angle : angle;
  }

  std::array<Batch, size_t(batches)> batches_;
};

/// Cosine of the angle about the center of a box of unit vectors that certainly holds them: none of them lies
/// farther from the center than a corner, and none has less of the center's direction than some corner.
template <int batches>
Float8 LightCosts<batches>::Batch::cos_of_axes() const {
  Float8 center2{}, half2{}, least{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const Float8& c = center[axis];
    center2 += c * c;
    half2 += half[axis] * half[axis];
    least += c * c - (c < 0 ? -c : c) * half[axis];
  }
  Float8 along = 0.5f * (1 + center2 - half2);
  keep_greater(least, along);
  const Float8 cosine = along / square_root(center2);
  return center2 > 1e-6f ? (cosine < 1 ? (cosine > -1 ? cosine : Float8{} - 1) : Float8{} + 1) : Float8{} - 1;
}

template <int batches>
Float8 LightCosts<batches>::Batch::solid_angle() const {
  // The spread of the axes and that of each light about its own.
  const Float8 axes = cos_of_axes();
  const Float8 both = axes * cos_spread - sine_of(axes) * sine_of(cos_spread);
  const Float8 cos_all = axes > -cos_spread ? both : Float8{} - 1, sin_all = sine_of(cos_all);
  const Float8 sin_emission = sine_of(cos_emission);
  // What is covered with less than full strength begins at the spread and ends at `widest`.
  const Mask8 everywhere = cos_all <= -cos_emission;
  const Float8 spread = arc_cosine(cos_all), emission = arc_cosine(cos_emission);
  const Float8 widest = everywhere ? Float8{} + pi : spread + emission;
  const Float8 cos_widest = everywhere ? Float8{} - 1 : cos_all * cos_emission - sin_all * sin_emission,
               sin_widest = everywhere ? Float8{} : sin_all * cos_emission + cos_all * sin_emission;
  const Float8 cos_twice = 2 * cos_widest * cos_widest - 1, sin_twice = 2 * sin_widest * cos_widest;
  return 2 * pi * (1 - cos_all) +
         pi / 2 * (2 * (widest - spread) * sin_all - (cos_all * cos_twice + sin_all * sin_twice) + cos_all);
}

}  // namespace vernier
