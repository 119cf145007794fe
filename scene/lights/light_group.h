// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <limits>

#include "core/math/simd.h"
#include "scene/lights/light_bounds.h"

namespace vernier {

/// A light of a tree that is being built, which moves it about.
struct PlacedLight {
  LightBounds bounds;
  uint32_t light = 0;

  /// Four floats that begin at one of those of `bounds`; the fourth is what follows there.
  Float4 lower() const { return floats_at(0); }
  Float4 upper() const { return floats_at(offsetof(Bounds, upper)); }
  /// And the cosine of its spread.
  Float4 axis() const { return floats_at(offsetof(LightBounds, axis)); }
  Float4 center() const { return (lower() + upper()) * 0.5f; }

 private:
  Float4 floats_at(size_t offset) const {
    Float4 floats;
    std::memcpy(&floats, reinterpret_cast<const char*>(&bounds) + offset, sizeof floats);
    return floats;
  }
};
static_assert(offsetof(LightBounds, box) == 0 && offsetof(LightBounds, axis) == sizeof(Bounds) &&
              offsetof(LightBounds, cos_spread) == sizeof(Bounds) + sizeof(Vec3f));

/// What a group of lights has in common, as least and greatest values: a light is taken in by a handful of
/// comparisons, and in any order. The fourth lanes hold the least cosine of a spread, or nothing.
struct LightGroup {
  Float4 lower = all(greatest), upper = all(-greatest);                ///< of the boxes
  Float4 center_lower = all(greatest), center_upper = all(-greatest);  ///< of their centers
  Float4 axis_lower = all(greatest), axis_upper = all(-greatest);
  Float4 first_axis{};  ///< of two-sided groups: axes are turned to its side
  float power = 0, cos_emission = 1;
  bool two_sided = false;

  bool empty() const { return power == 0; }
  /// The least among the members' cosines of the spread.
  float cos_spread() const { return axis_lower[3]; }

  void add(const PlacedLight& light) {
    const Float4 center = light.center();
    const Float4 axis = turned(light.axis(), light.bounds.two_sided);
    add_extents(light.lower(), light.upper(), center, center, axis, axis);
    power += light.bounds.power;
    cos_emission = std::min(cos_emission, light.bounds.cos_emission);
  }

  void add(const LightGroup& group) {
    if (group.empty()) return;
    // Turned, what was least is greatest.
    const Float4 a = turned(group.axis_lower, group.two_sided, group.first_axis),
                 b = turned(group.axis_upper, group.two_sided, group.first_axis);
    add_extents(group.lower, group.upper, group.center_lower, group.center_upper, a < b ? a : b,
                a < b ? b : a);
    power += group.power;
    cos_emission = std::min(cos_emission, group.cos_emission);
  }

  /// The axis as it counts here: of groups that shine along it both ways turned to the side of the first.
  Float4 turned(const Float4& axis) const {
    const Float4 product = axis * first_axis;
    return two_sided && product[0] + product[1] + product[2] < 0 ? reversed(axis) : axis;
  }

 private:
  static constexpr float greatest = std::numeric_limits<float>::infinity();
  static Float4 all(float x) { return Float4{} + x; }
  static Float4 reversed(const Float4& axis) { return axis * Float4{-1, -1, -1, 1}; }

  Float4 turned(const Float4& axis, bool is_two_sided) { return turned(axis, is_two_sided, axis); }
  Float4 turned(const Float4& axis, bool is_two_sided, const Float4& first) {
    if (empty()) first_axis = first;
    if (!(two_sided |= is_two_sided)) return axis;
    const Float4 product = first * first_axis;
    return product[0] + product[1] + product[2] < 0 ? reversed(axis) : axis;
  }

  void add_extents(const Float4& box_lower, const Float4& box_upper, const Float4& middle_lower,
                   const Float4& middle_upper, const Float4& least_axis, const Float4& greatest_axis) {
    lower = box_lower < lower ? box_lower : lower;
    upper = box_upper > upper ? box_upper : upper;
    center_lower = middle_lower < center_lower ? middle_lower : center_lower;
    center_upper = middle_upper > center_upper ? middle_upper : center_upper;
    axis_lower = least_axis < axis_lower ? least_axis : axis_lower;
    axis_upper = greatest_axis > axis_upper ? greatest_axis : axis_upper;
  }
};

}  // namespace vernier
