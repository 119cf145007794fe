// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "vernier/math.h"

namespace vernier {

/// A triangle by its numbers in the scene; the default is none.
struct TriangleId {
  static constexpr uint32_t none = 0xffffffff;
  uint32_t instance = none, primitive = none;
  bool operator==(const TriangleId&) const = default;
};

constexpr float middle_of_shutter = 0.5f;

/// Half-line origin + t direction, for t in (t_min, t_max). The direction need not be a unit vector: t counts
/// in its length.
struct Ray {
  Vec3f origin{0, 0, 0};
  float t_min = 0;
  Vec3f direction{0, 0, 1};
  float t_max = std::numeric_limits<float>::infinity();
  /// The triangles on whose planes the ray begins and ends. A line meets a plane once, so they cannot stand
  /// in between, whatever a test that rounds may say of slivers; accelerators let the ray pass them.
  TriangleId origin_triangle{}, target_triangle{};
  /// When it travels: 0 as the shutter opens, 1 as it closes. Nothing to what stands still.
  float time = middle_of_shutter;

  Vec3f at(float t) const { return origin + t * direction; }
};

}  // namespace vernier
