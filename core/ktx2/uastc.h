// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/ktx2/container.h"

namespace vernier::ktx2 {

/// Decodes the base level into a texture of its size. Throws Error(input).
void decode_uastc(const Container& container, Texture& texture);

}  // namespace vernier::ktx2
