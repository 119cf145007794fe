#pragma once

#include "core/image/denoise.h"

// The filters behind denoise.h's table, and what they share.

namespace vernier {

/// A picture made ready: finite, divided by albedo, with its variance and the guides as distances.
struct GuidedImage {
  Image color;
  Image variance;    ///< of each value of `color`; never negative
  Image features;    ///< any number of channels, scaled so that a distance of 1 is a clear difference; may be
                     ///< empty
  Image modulation;  ///< to multiply the filtered `color` by
};

/// Throws Error(usage) when sizes or channels are wrong.
GuidedImage prepare(const NoisyImage& noisy);

/// `filtered` times the modulation.
Image modulate(Image filtered, const GuidedImage& guided);

/// Noise variance of each value, from the picture alone: the response to a mask that neither planes nor edges
/// along the axes excite (Immerkaer 1996, "Fast Noise Variance Estimation"), averaged over 7 x 7 pixels.
Image estimate_variance(const Image& color);

Image denoise_gaussian(const NoisyImage& noisy);
Image denoise_bilateral(const NoisyImage& noisy);
Image denoise_median(const NoisyImage& noisy);
Image denoise_nlm(const NoisyImage& noisy);
#ifdef VERNIER_OIDN
Image denoise_oidn(const NoisyImage& noisy);
#endif

}  // namespace vernier
