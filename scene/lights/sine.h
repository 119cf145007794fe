// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/simd.h"

namespace vernier {

/// Of angles in [0, pi] by their cosines; 0 where rounding took a cosine beyond 1.
inline Float8 sine_of(const Float8& cosine) {
  Float8 square = 1 - cosine * cosine;
  keep_greater(Float8{}, square);
  return square_root(square);
}

}  // namespace vernier
