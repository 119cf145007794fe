// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "vernier/settings.h"

namespace vernier {

/// As --texture-filter takes it: "none", "mip" or "mip:0.5". Throws Error(usage).
TextureFilter parse_texture_filter(std::string_view text);
/// The same from a filter; the width is said unless there is none.
std::string texture_filter_text(const TextureFilter& filter);
/// Throws Error(usage) unless the width is one that TextureFilter may have, and the integrator reads textures
/// so.
void check_texture_filter(const RenderSettings& settings);

}  // namespace vernier
