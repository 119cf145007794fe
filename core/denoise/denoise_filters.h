// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/denoise/denoise.h"

// The filters behind denoise.h's table, one file each, and what they share.

namespace vernier {

/// The mean of the finite pixels nearby in place of pixels that are not finite, or beyond 1e18.
Image fill_not_finite(const Image& image);

/// The same for every layer. Throws Error(usage) when sizes or channels are wrong.
NoisyImage made_finite(const NoisyImage& noisy);

/// A picture made ready: finite, divided by albedo, with its variance and the guides as distances.
struct GuidedImage {
  Image color;
  Image variance;  ///< of each value of `color`; never negative
  Image features;  ///< any number of channels, none too, scaled so that a distance of 1 is a clear difference
  Image modulation;  ///< to multiply the filtered `color` by
};

/// Throws Error(usage) when sizes or channels are wrong.
GuidedImage prepare(const NoisyImage& noisy);

/// `filtered` times the modulation.
Image modulate(Image filtered, const GuidedImage& guided);

/// How pixel q counts for pixel p: by the distance of p and q, of their colours, and of their features.
struct Weights {
  int radius = 0;            ///< of the square window
  float deviation = 0;       ///< of the spatial Gaussian, pixels; 0: none
  float color_distance = 0;  ///< k: k standard errors are a clear difference; 0: colour does not count
  int patch_radius = 0;      ///< colours are compared over squares of this radius
};

/// The weighted average about each pixel. A picture of one value stays as it is to the bit.
Image weighted_average(const GuidedImage& guided, const Weights& weights);

/// `smooth` and what the noise cannot explain of the picture's difference from it: the part beyond two
/// standard errors (Lee 1980, "Digital Image Enhancement and Noise Filtering by Use of Local Statistics").
Image keep_unexplained(Image smooth, const GuidedImage& guided);

Image denoise_gaussian(const NoisyImage& noisy);
Image denoise_bilateral(const NoisyImage& noisy);
Image denoise_median(const NoisyImage& noisy);
Image denoise_nlm(const NoisyImage& noisy);

/// Open Image Denoise, where its library is found. Throws Error(usage) when it is not, or with what the
/// library says is wrong.
Image denoise_oidn(const NoisyImage& noisy);

}  // namespace vernier
