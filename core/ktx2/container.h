// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/ktx2/ktx2.h"

namespace vernier::ktx2 {

/// How texels are stored.
enum class Format { etc1s, uastc, plain };

/// The parts of a KTX2 file that its base level needs. Spans point into the file and lie inside it.
struct Container {
  uint32_t width = 0, height = 0;
  Format format = Format::etc1s;
  uint32_t plain_channels = 0;      ///< bytes of a texel that is not compressed
  bool has_green_in_alpha = false;  ///< and red in the first three channels
  bool has_second_slice = false;    ///< a second picture holds alpha or green
  bool is_zstandard = false;        ///< the level is compressed on top of that (RFC 8878)
  TransferFunction transfer = TransferFunction::other;
  std::vector<std::string> remarks;
  uint32_t image_count = 1;  ///< pictures of all levels
  std::span<const uint8_t> level;
  uint64_t uncompressed_size = 0;        ///< of the level, in bytes
  std::span<const uint8_t> global_data;  ///< codebooks of ETC1S
};

/// Reads the header, level index, data format descriptor and metadata (KTX 2.0; Khronos Data Format 1.3).
/// Throws Error(input) for what is damaged or not a single 2D picture in one of the formats.
Container parse_container(std::span<const uint8_t> file, uint64_t max_texels);

}  // namespace vernier::ktx2
