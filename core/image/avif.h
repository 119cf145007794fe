// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "core/image/image_header.h"
#include "core/image/image_io.h"

namespace vernier {

/// Decodes an AVIF picture whose header was parsed to three channels, or four with alpha: eight bits where
/// the file has eight, else sixteen, which 10 and 12 bits are spread over. Throws Error(input), also for a
/// picture that is larger than its header says.
CodedImage decode_avif(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name);

}  // namespace vernier
