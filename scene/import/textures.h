#pragma once

#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/import/document.h"

namespace vernier {

/// An image of a file, decoded.
struct DecodedImage {
  std::shared_ptr<const Image8> pixels;  ///< null: cannot be decoded
  std::string problem;
  std::string fingerprint;  ///< empty: in a buffer
};

/// Reads and decodes an image by its index. A missing file is Error(input).
DecodedImage decode_image(const Document& document, int index);

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
