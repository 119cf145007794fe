// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/vernier/notice_log.h"
#include "integrators/render/render.h"

// What a picture leaves out, in words and figures.

namespace vernier::apps {

/// Below this part of all light nothing is said.
inline constexpr double least_missing_share = 1e-3;

/// " + up to 38 % of all light missing behind glass", after the error; empty when next to nothing is known to
/// be missing.
std::string missing_text(const MissingEstimate& missing);

/// Warnings that say what to do about it.
void warn_of_missing_light(const RenderResult& result, int max_depth, NoticeLog& log);

/// The part of the --stats file; docs/stats.md documents every field.
nlohmann::ordered_json missing_json(const MissingEstimate& missing);

/// Whether what is missing alone makes the picture more wrong than `target_error`.
bool exceeds(const MissingEstimate& missing, double target_error);

}  // namespace vernier::apps
