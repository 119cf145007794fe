// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "core/image/image_header.h"
#include "core/image/image_io.h"

// What image_io.cpp and image_decode.cpp share.

namespace vernier {

/// Throws Error(input) for a size that is empty, above the caps, or out of all proportion to the file.
void check_image_size(const std::string& name, int64_t width, int64_t height, int channels,
                      uint64_t file_bytes, const ImageLimits& limits, int64_t most_values_per_byte = 4096);

/// All channels of a whole PNG, JPEG, WebP or AVIF whose header was parsed; eight or sixteen bits become
/// floats in [0, 1]. Throws Error(input).
Image decode_image(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name,
                   const ImageLimits& limits);

}  // namespace vernier
