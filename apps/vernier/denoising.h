// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "integrators/render/denoise_picture.h"

// What is said of denoising a picture, as `vernier denoise`, `develop` and `render --denoise` do.

namespace vernier::apps {

/// Prints the filters when `filter` is "help"; false: it is not.
bool print_requested_denoisers(const std::string& filter);

/// "denoised by nlm: error 1.02 % (1.01 to 1.03 %), 3.21 % before"
std::string denoised_text(const Denoiser& denoiser, const std::optional<DenoisedError>& error);

/// The same for --stats.
nlohmann::ordered_json denoised_json(const Denoiser& denoiser, const std::optional<DenoisedError>& error);

}  // namespace vernier::apps
