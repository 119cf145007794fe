// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ktx2/ktx2.h"
#include "scene/import/document.h"
#include "vernier/texture.h"

namespace vernier {

/// An image of a file, decoded.
struct DecodedImage {
  std::optional<TexturePixels> pixels;             ///< empty: missing or cannot be decoded
  std::string problem;                             ///< why there are no pixels
  std::vector<std::string> remarks;                ///< what a user should know about those there are
  std::string fingerprint;                         ///< empty: in a buffer or not read
  std::optional<ktx2::TransferFunction> transfer;  ///< that the file states; other kinds of files do not
  std::string basisu_problem;  ///< why KHR_texture_basisu does not allow the pixels; empty: it does
};

/// Reads and decodes an image by its index. Throws Error(input) on a reference that is not to be followed.
DecodedImage decode_image(const Document& document, int index);

/// Bytes of an image's texels once it is decoded, as far as the header of its file tells; 0: nothing does.
/// Throws Error(input) on a reference that is not to be followed.
uint64_t expected_bytes(const Document& document, int index);

}  // namespace vernier
