// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/picture.h"

namespace vernier {

/// `options` with the whole name of its view: the one asked for, of which the first letters suffice, else the
/// config's default. Throws Error(usage) when there is no such view, Error(input) on an unusable config.
DisplayOptions with_chosen_view(DisplayOptions options);

/// Scene-linear Rec.709 to 8-bit display values through OpenColorIO. A fourth channel is alpha, by which the
/// other three are multiplied (associated); in the result they are not, as PNG has it (ISO/IEC 15948, 6.2).
/// Throws Error(usage) on an unknown view, listing the ones there are, and Error(input) on an unusable
/// config.
Image8 to_display(const Image& scene_linear, const DisplayOptions& options);

}  // namespace vernier
