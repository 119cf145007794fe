// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/film/film.h"

// What a film's samples say about its pixels besides their values: shared by the error estimates of the image
// and of each pixel.

namespace vernier {

/// Square of half the difference of the halves: its expectation is the variance of the pixel.
Vec3d squared_half_difference(const Film& film, int x, int y);
/// Variance that the pixel would have if its samples were independent. They are stratified: most pixels have
/// less.
Vec3d iid_variance(const Film& film, int x, int y);

struct PixelReliability {
  /// Three channels: what infinitely many samples would probably give. Differs from the film's pixels where
  /// these are noisy, and is nearly independent of their errors.
  Image shrunk_mean;
  /// One channel, 1 where the pixel's error cannot be known from what was sampled, else 0.
  Image unreliable;
};
PixelReliability assess_pixels(const Film& film);
/// Memory that it takes while it runs, the result included.
size_t assess_pixels_bytes_per_pixel();

}  // namespace vernier
