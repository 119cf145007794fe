// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/import/decode_image.h"
#include "scene/import/document.h"
#include "scene/import/specular_glossiness.h"
#include "scene/import/texture_memory.h"
#include "vernier/scene.h"

namespace vernier {

/// A texture that materials use, and what for.
struct WantedTexture {
  int index = -1;
  bool as_srgb = false, as_linear = false;
};

/// Textures of a file, decoded.
struct DecodedTextures {
  std::vector<Texture> textures;
  std::vector<bool> unreadable;           ///< by texture: replaced by one magenta texel
  std::vector<std::string> fingerprints;  ///< of the image files read, in the file's order
};

/// Pictures of a file that have been decoded, for descriptions of it to come.
struct ImageCache {
  std::map<int, DecodedImage> images;      ///< by the file's index
  std::map<int, TexturePixels> roughness;  ///< by that of `derived`
  TextureMemory memory;                    ///< where they are
};

/// Reads and decodes the textures asked for, in parallel; textures of one image share its pixels. They are
/// indices of the file or, beyond those, of `derived`. Images that extensions name come first; where one is
/// missing or cannot be decoded the texture's own stands for it, and a magenta texel for that, each with a
/// notice. Throws Error(input) on a reference that is not to be followed, and where the file requires the
/// extension of an image that nothing stands for. What `cache` holds is not decoded again, and the rest is
/// added to it; Error(output) is thrown where its memory needs a file and can have none.
DecodedTextures read_textures(const Document& document, const std::vector<WantedTexture>& wanted,
                              const std::vector<RoughnessFromGlossiness>& derived, ImageCache& cache,
                              std::vector<Notice>& notices);

}  // namespace vernier
