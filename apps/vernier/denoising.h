// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/denoise/denoise.h"
#include "core/image/image_io.h"

// Denoising a picture by its layers, as both `vernier denoise` and `vernier render --denoise` do.

namespace vernier::apps {

/// Layers that denoising wants of a render, as --aov takes them.
inline constexpr const char* layers_for_denoising = "error,half,albedo,normal,coverage";

/// Prints the filters when `filter` is "help"; false: it is not.
bool print_requested_denoisers(const std::string& filter);

struct Denoised {
  Image picture;
  std::optional<DenoisedError> error;  ///< when the picture came with its halves
  std::optional<Image> pixel_error;    ///< with `error`: of each value (core/image/denoise.h)
};

/// The colour of `picture` denoised, guided by the layers error, albedo and N when they are there, as two
/// halves when half1 and half2 are there and the colour is their mean. Throws Error(usage).
Denoised denoise(const LayeredImage& picture, const Denoiser& denoiser);

/// Puts the denoised colour into `picture`, whose first three channels are the noisy one, and its error into
/// the layer `error`. What that layer held goes on as `noisyError`; when the error is not known there is no
/// layer `error` any more.
void put_into(LayeredImage& picture, const Denoised& denoised);

/// "denoised by nlm: error 1.02 % (1.01 to 1.03 %), 3.21 % before"
std::string denoised_text(const Denoiser& denoiser, const std::optional<DenoisedError>& error);

/// The same for --stats.
nlohmann::ordered_json denoised_json(const Denoiser& denoiser, const std::optional<DenoisedError>& error);

/// Image header entries that say so.
Metadata denoised_metadata(const Denoiser& denoiser, const std::optional<DenoisedError>& error);

}  // namespace vernier::apps
