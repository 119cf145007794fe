// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "vernier/result.h"

// When is a picture good enough?

namespace vernier {

/// Ratio of the estimated error to the one asked for: of the figure itself, or of the end of its interval
/// over 1.1, whichever is larger. At 1 the picture is good enough, and with 97.5 % confidence not much worse
/// than asked. Not a number while the error is not known.
inline double error_ratio(const ErrorEstimate& error, double asked) {
  return std::max(error.rel_rmse, error.high / 1.1) / asked;
}

/// Samples a pixel, of those that have been taken and those to come, with which a picture probably has the
/// error asked for: the square of the error falls as they grow. A tenth is added for what the estimate
/// scatters. 0: it is reached.
inline double samples_for_error(const ErrorEstimate& error, double samples_per_pixel, double asked) {
  constexpr double margin = 1.1, unknown = 4;
  const double excess = error_ratio(error, asked);
  if (excess <= 1) return 0;
  return samples_per_pixel * (std::isfinite(excess) ? margin * excess * excess : unknown);
}

}  // namespace vernier
