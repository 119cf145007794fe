// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/ktx2/texels.h"

namespace vernier::ktx2 {

constexpr size_t uastc_block_size = 16;

/// The texels of a UASTC LDR 4x4 block as ASTC makes them without sRGB; empty when it is of a mode or pattern
/// that does not exist.
std::optional<std::array<TexelRow, 4>> decode_uastc_block(std::span<const uint8_t, uastc_block_size> block);

}  // namespace vernier::ktx2
