#pragma once

#include <limits>

#include "core/math/vec.h"

namespace vernier {

/// Half-line origin + t direction, for t in (t_min, t_max). The direction need not be a unit vector: t counts
/// in its length.
struct Ray {
  Vec3f origin{0, 0, 0};
  float t_min = 0;
  Vec3f direction{0, 0, 1};
  float t_max = std::numeric_limits<float>::infinity();

  Vec3f at(float t) const { return origin + t * direction; }
};

}  // namespace vernier
