// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vernier/settings.h"

namespace vernier {

/// What the samples of a render depend on, as names and values for people to read: "seed" "7"; each name
/// once. Two renders with equal ones may go on from each other.
using RenderIdentity = std::vector<std::pair<std::string, std::string>>;

/// All but the limits.
RenderIdentity identity_of(const RenderSettings& settings);

/// "surroundings", "transparent", "0.5,0.5,0.5" or a file.
std::string background_text(const Background& background);

/// "auto", "on" or "off". Throws Error(usage).
Caustics parse_caustics(std::string_view name);

/// "640x360+10+20", as --crop takes it.
std::string crop_text(const Crop& crop);

}  // namespace vernier
