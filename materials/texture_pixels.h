// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <variant>

#include "core/base/paged_file.h"
#include "vernier/texture.h"

// Where the pixels of textures are: in memory or in a PagedFile.

namespace vernier {

using PixelsInMemory = std::variant<std::shared_ptr<const Image8>, std::shared_ptr<const Image16>>;

/// All of a picture, in memory: itself, or a copy for as long as somebody has it.
PixelsInMemory in_memory(const TexturePixels& pixels);

/// A picture that is taken to `file`. Where that is null, and where it would not fill a block, it stays in
/// memory.
TexturePixels in_file(const PixelsInMemory& pixels, const std::shared_ptr<PagedFile>& file);

/// Null: in memory.
std::shared_ptr<PagedFile> file_of(const TexturePixels& pixels);

/// Bytes of the texels, wherever they are.
uint64_t texel_bytes(const TexturePixels& pixels);

}  // namespace vernier
