// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/texture_pixels.h"

namespace vernier {

/// A roughness texture made from a specular-glossiness texture of the file, whose alpha is glossiness.
struct RoughnessFromGlossiness {
  int texture = -1;  ///< index in the file
  float factor = 1;  ///< glossinessFactor, which multiplies the texel before roughness is taken from it

  bool operator==(const RoughnessFromGlossiness&) const = default;
};

/// Green is 1 - factor x alpha, as metallic-roughness textures have it; exact but for the rounding to the
/// bits of the source, since filtering a texture and taking it from 1 commute.
PixelsInMemory roughness_of(const PixelsInMemory& specular_glossiness, float factor);

}  // namespace vernier
