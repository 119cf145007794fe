// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vernier/picture.h"

namespace vernier {

/// A noisy picture and what is known of it; all of one size, three channels each. Layers that are absent
/// guide nothing.
struct NoisyImage {
  Image color;                       ///< scene-linear Rec.709
  std::optional<Image> error = {};   ///< standard error of each value of `color`; else estimated from it
  std::optional<Image> albedo = {};  ///< reflectance: `color` is filtered divided by it, to keep texture
  std::optional<Image> normal = {};  ///< unit vectors: pixels that face elsewhere are not mixed
  /// One channel: where it is 0, the pixel shows no surface and does not count in the picture's error, unless
  /// that is so everywhere.
  std::optional<Image> coverage = {};
};

/// One line of the table of denoisers. `filter` is a pure function. Pixels that are not finite, or beyond
/// 1e18, are replaced by their neighbors' mean first; what comes out is finite, and not negative where
/// nothing is that goes in. Throws Error(usage) when sizes differ.
struct Denoiser {
  std::string_view name;
  std::string_view description;
  Image (*filter)(const NoisyImage&);
  /// A network. Of all others more is known: equal input gives equal bits on any number of threads, a picture
  /// of one value stays as it is, values of any size keep it where they are sure, and `error` is heeded.
  bool learned = false;
};

/// Memory that filtering a picture with all its layers and its two halves takes while it runs, beside the
/// picture: the most of any filter of ours. A network takes what its library says.
size_t denoise_bytes_per_pixel();

/// All denoisers that there are on this machine (core/denoise/denoise.cpp).
std::span<const Denoiser> denoisers();

/// All names that find_denoiser() may take, whether or not they are there.
std::vector<std::string> denoiser_names();

/// The denoiser of that name; of "auto" Open Image Denoise where its library is found, else the first. Throws
/// Error(usage) that lists the names there are, or says why that one, or a library that was named, is not.
const Denoiser& find_denoiser(std::string_view name);

/// A picture denoised as two halves, so that its own error, what the filter blurs included, is known.
struct DenoisedHalves {
  Image picture;  ///< mean of the two filtered halves
  DenoisedError error;
  /// Of each value: what its pixel is probably off by, blur included. The shape is that of the noise left
  /// over 15 x 15 pixels; the size is such that over the picture the squares add up to `error`.
  Image pixel_error;
};

/// Filters each half by itself. The halves must be independent and of one expectation; layers may be shared.
/// docs/denoise.md says how the error is known. Throws Error(usage) when sizes differ.
DenoisedHalves denoise_halves(const Denoiser& denoiser, const NoisyImage& first, const NoisyImage& second);

}  // namespace vernier
