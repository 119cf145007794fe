// SPDX-License-Identifier: Apache-2.0
#include "scene/import/course.h"

#include <algorithm>
#include <limits>

namespace vernier {

bool Course::moves(double distance) const {
  constexpr double rounding = 2 * std::numeric_limits<float>::epsilon();
  for (const auto& points : points_)
    for (size_t i = 0; i < points.size(); ++i)
      if (length(points[i] - points_[0][i]) > distance + rounding * length(points[i])) return true;
  return false;
}

std::optional<int> Course::level(int sampled, double tolerance) const {
  for (int level = 0; level < sampled; ++level)
    if (fits(level, sampled, tolerance)) return level;
  return sampled == finest ? std::optional(finest) : std::nullopt;
}

bool Course::fits(int level, int sampled, double tolerance) const {
  for (size_t k = 0; k < most_moments; k += stride(sampled)) {
    const size_t from = std::min(k / stride(level) * stride(level), most_moments - 1 - stride(level));
    const double part = double(k - from) / double(stride(level));
    const auto &a = points_[from], &b = points_[from + stride(level)], &here = points_[k];
    for (size_t i = 0; i < here.size(); ++i)
      if (length(a[i] * (1 - part) + b[i] * part - here[i]) > tolerance) return false;
  }
  return true;
}

}  // namespace vernier
