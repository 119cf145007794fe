// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "vernier/math.h"

namespace vernier {

/// Axis-aligned box; empty until something is added.
struct Bounds {
  Vec3f lower{std::numeric_limits<float>::infinity()};
  Vec3f upper{-std::numeric_limits<float>::infinity()};

  bool empty() const { return !(lower.x <= upper.x); }
  void add(const Vec3f& p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  void add(const Bounds& b) {
    lower = min(lower, b.lower);
    upper = max(upper, b.upper);
  }
  bool contains(const Vec3f& p) const {
    return lower.x <= p.x && lower.y <= p.y && lower.z <= p.z && p.x <= upper.x && p.y <= upper.y &&
           p.z <= upper.z;
  }
  /// Both have a point in common.
  bool touches(const Bounds& b) const {
    return lower.x <= b.upper.x && lower.y <= b.upper.y && lower.z <= b.upper.z && b.lower.x <= upper.x &&
           b.lower.y <= upper.y && b.lower.z <= upper.z;
  }
  Vec3f center() const { return (lower + upper) * 0.5f; }
  /// Radius of the sphere about the center through the corners; 0 when empty.
  float radius() const { return empty() ? 0 : length(upper - lower) / 2; }
  /// Half the surface area; 0 when empty.
  float half_area() const {
    if (empty()) return 0;
    const Vec3f d = upper - lower;
    return d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

}  // namespace vernier
