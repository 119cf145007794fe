// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/denoise/denoise.h"
#include "vernier/image.h"

// Denoising a picture by its layers.

namespace vernier {

struct Denoised {
  Image picture;
  std::optional<DenoisedError> error;  ///< when the picture came with its halves
  std::optional<Image> pixel_error;    ///< with `error`: of each value (core/denoise/denoise.h)
};

/// The colour of `picture` denoised, guided by the layers error, albedo and N when they are there, as two
/// halves when half1 and half2 are there and the colour is their mean. Throws Error(usage).
Denoised denoise(const LayeredImage& picture, const Denoiser& denoiser);

/// Puts the denoised colour into `picture`, whose first three channels are the noisy one, and its error into
/// the layer `error`. What that layer held goes on as `noisyError`; when the error is not known there is no
/// layer `error` any more.
void replace_color(LayeredImage& picture, const Denoised& denoised);

/// Image header entries that say so.
Metadata denoised_metadata(const Denoiser& denoiser, const std::optional<DenoisedError>& error);

}  // namespace vernier
