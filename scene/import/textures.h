// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/import/document.h"
#include "scene/import/specular_glossiness.h"
#include "vernier/scene.h"

namespace vernier {

/// An image of a file, decoded.
struct DecodedImage {
  std::shared_ptr<const Image8> pixels;  ///< null: missing or cannot be decoded
  std::string problem;                   ///< why there are no pixels
  std::vector<std::string> remarks;      ///< what a user should know about those there are
  std::string fingerprint;               ///< empty: in a buffer or not read
};

/// Reads and decodes an image by its index. Throws Error(input) on a reference that is not to be followed.
DecodedImage decode_image(const Document& document, int index);

/// Textures of a file, decoded.
struct DecodedTextures {
  std::vector<Texture> textures;
  std::vector<bool> unreadable;           ///< by texture: replaced by one magenta texel
  std::vector<std::string> fingerprints;  ///< of the image files read, in the file's order
};

/// Reads and decodes the textures asked for, in parallel; textures of one image share its pixels. They are
/// indices of the file or, beyond those, of `derived`. A missing image or one that cannot be decoded becomes
/// magenta, with a notice. Throws Error(input) on a reference that is not to be followed.
DecodedTextures read_textures(const Document& document, const std::vector<int>& wanted,
                              const std::vector<RoughnessFromGlossiness>& derived,
                              std::vector<Notice>& notices);

}  // namespace vernier
