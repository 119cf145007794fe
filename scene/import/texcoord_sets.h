// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "vernier/material.h"

namespace vernier {

/// Which of a file's TEXCOORD_n a material reads as its sets 0 and 1.
struct TexcoordSets {
  std::array<int, 2> of_slot{0, 1};
  size_t wanted = 0;   ///< different sets that the material asked for; of more than two the rest is lost
  int substitute = 0;  ///< the set that stands for those lost
};

/// Renumbers the sets of texture coordinates that the material's textures name, by the file, to the two that
/// meshes have. Sets 0 and 1 keep their numbers.
TexcoordSets assign_texcoord_sets(MaterialDescription& material);

}  // namespace vernier
