// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/vernier/denoising.h"
#include "core/display/display.h"
#include "core/film/film.h"

namespace vernier::apps {

/// The page that `vernier render --report` writes: what --stats holds (docs/stats.md), for people, with the
/// picture and maps of its error; the denoised one too when there is one. `stats` itself is in it too, under
/// the id "stats".
std::string report_page(const nlohmann::ordered_json& stats, const Film& film,
                        const std::optional<Denoised>& denoised, const DisplayOptions& display);

}  // namespace vernier::apps
