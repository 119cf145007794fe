// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "vernier/image.h"

namespace vernier {

/// Correlates every channel with `horizontal` along rows and `vertical` along columns; both have an odd
/// number of weights, the middle one at the pixel itself. Beyond the picture its border pixels repeat.
Image convolve(const Image& image, std::span<const float> horizontal, std::span<const float> vertical);

}  // namespace vernier
