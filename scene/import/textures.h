#pragma once

#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/import/document.h"

namespace vernier {

/// Textures of a file, decoded.
struct DecodedTextures {
  std::vector<Texture> textures;
  std::vector<bool> unreadable;           ///< by texture: replaced by one magenta texel
  std::vector<std::string> fingerprints;  ///< of the image files read, in the file's order
};

/// Reads and decodes the textures asked for (indices in the file), in parallel; textures of one image share
/// its pixels. A missing image file is Error(input); one that cannot be decoded becomes magenta, with a
/// notice.
DecodedTextures read_textures(const Document& document, const std::vector<int>& wanted,
                              std::vector<Notice>& notices);

}  // namespace vernier
