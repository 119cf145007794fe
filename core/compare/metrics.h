// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "vernier/image.h"

namespace vernier {

/// Keeps relative errors of black pixels finite.
constexpr double relative_error_epsilon = 0.01;
/// A squared error relative to the value `r` that is right: of one channel of one pixel. Its mean is relMSE,
/// the root of that mean the relative RMSE.
inline double relative_squared(double squared_error, double r) {
  return squared_error / (r * r + relative_error_epsilon);
}

/// Differences between a picture x and a reference r of the same size, over the pixels that count and three
/// channels.
struct ImageDifference {
  double mse = 0;                                  ///< mean (x - r)^2
  double rel_mse = 0;                              ///< mean (x - r)^2 / (r^2 + 0.01)
  double mae = 0;                                  ///< mean |x - r|
  double largest = 0;                              ///< max |x - r|
  int largest_x = 0, largest_y = 0;                ///< pixel of `largest`, the first in reading order
  std::array<double, 3> mean{}, reference_mean{};  ///< per channel
  double reference_largest = 0;                    ///< max r
  int64_t not_finite =
      0;  ///< values of x or r that are NaN or infinite; each such pair is left out of the above

  double rmse() const { return std::sqrt(mse); }
  /// Peak signal-to-noise ratio, 10 log10(peak^2 / mse) in decibels; infinite when the pictures are equal.
  double psnr(double peak) const;
};

/// Over all pixels, or over those where the one channel of `shown` is not 0, unless it is 0 everywhere: as
/// ErrorEstimate counts pixels. Throws Error(usage) when sizes differ or a picture has fewer than three
/// channels.
ImageDifference difference(const Image& x, const Image& reference, const Image* shown = nullptr);

}  // namespace vernier
