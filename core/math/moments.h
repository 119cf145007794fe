// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

// Values at evenly spaced moments of the shutter, from its opening (time 0) to its closing (time 1).

namespace vernier {

/// Where a time lies: between moments `first` and `first` + 1, `part` of the way.
struct MomentPair {
  size_t first;
  float part;
};

/// time in [0, 1], count at least 2. Without rounding where count is 2^n + 1.
inline MomentPair moments_around(float time, size_t count) {
  const float scaled = time * static_cast<float>(count - 1);
  const size_t first = std::min(static_cast<size_t>(scaled), count - 2);
  return {first, scaled - static_cast<float>(first)};
}

/// Linear. Since each operation rounds monotonically, a <= c and b <= d give between(a, b) <= between(c, d):
/// what bounds a vertex at two moments bounds it in between, to the last bit. (The project is compiled
/// without contraction, which might round the two sides differently.)
template <typename T>
T between(const T& a, const T& b, float part) {
  return a * (1 - part) + b * part;
}

}  // namespace vernier
