// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace vernier {

/// What the first bytes of a PNG, JPEG, WebP or AVIF file say, read without decoding, so that a file is
/// refused before any library allocates for it.
struct ImageHeader {
  const char* format = "";        ///< OpenImageIO's name of the format
  int64_t width = 0, height = 0;  ///< zero when the header ends before it gives them
  bool intact = false;   ///< the file reaches its format's own end mark, and PNG's checksums are right
  bool cut_off = false;  ///< else: it ends before that mark, and what there is has nothing wrong
  /// What no file of the format has more of. Of most: deflate packs 1,032 values a byte, JPEG a bit a block.
  int64_t most_pixels_per_byte = 4096;
  int bytes_per_pixel = 4;  ///< once decoded, as far as the beginning tells
};

/// Checksum of a PNG chunk (ISO/IEC 15948, 5.5).
uint32_t png_checksum(std::span<const uint8_t> type_and_data);

/// Empty when the bytes begin with none of the four signatures.
std::optional<ImageHeader> parse_image_header(std::span<const uint8_t> bytes);

}  // namespace vernier
