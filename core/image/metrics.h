#pragma once

#include <array>

#include "core/image/image.h"

namespace vernier {

/// Differences between a picture x and a reference r of the same size, over all pixels and three channels.
struct ImageDifference {
  double mse = 0;                  ///< mean (x - r)^2
  double rel_mse = 0;              ///< mean (x - r)^2 / (r^2 + 0.01)
  double mae = 0;                  ///< mean |x - r|
  double largest = 0;              ///< max |x - r|
  int largest_x = 0, largest_y = 0;  ///< pixel of `largest`
  std::array<double, 3> mean{}, reference_mean{};  ///< per channel
  int64_t not_finite = 0;          ///< values of either that are NaN or infinite; left out of everything above
};

/// Throws Error(usage) when sizes differ or either has fewer than three channels.
ImageDifference difference(const Image& x, const Image& reference);

}  // namespace vernier
