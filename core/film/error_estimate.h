// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/film/film.h"

namespace vernier {

/// How wrong a film's image probably is, without a reference. docs/error.md says what the figures mean and
/// how they are verified.
struct ErrorEstimate {
  /// Relative RMSE of the image, sqrt(mean((x - r)^2 / (r^2 + 0.01))) over pixels and channels, x the image
  /// and r the truth, with the ends of a 95 % interval for the error that this very image has. Not a number
  /// while some pixel lacks a sample in either half.
  double rel_rmse = 0, low = 0, high = 0;
  /// Part of the pixels whose error figure is not to be trusted: too few samples, or most of what is known of
  /// them comes from too few.
  double unreliable = 0;
};

/// The image's error; what a render looks at between passes.
ErrorEstimate estimate_error(const Film& film);
/// Memory that it takes while it runs.
size_t estimate_error_bytes_per_pixel();

/// The same for every pixel.
struct ErrorLayers {
  Image standard_error;  ///< three channels: estimated standard deviation of the pixel's mean
  Image unreliable;      ///< one channel: 1 where standard_error is not to be trusted, else 0
};
ErrorLayers error_layers(const Film& film);
/// Memory that it takes while it runs, the result included.
size_t error_layers_bytes_per_pixel();

}  // namespace vernier
