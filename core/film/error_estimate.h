// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/film/film.h"
#include "vernier/result.h"

namespace vernier {

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
