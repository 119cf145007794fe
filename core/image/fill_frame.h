// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/image.h"

namespace vernier {

/// A three-channel picture resampled to fill a frame of `width` x `height` pixels: centred, its shape kept,
/// what the frame has no place for cut off. Values stay within the range of those around them.
Image fill_frame(const Image& picture, int width, int height);

}  // namespace vernier
