// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "vernier/material.h"

namespace vernier {

/// Renumbers the sets of texture coordinates that the material's textures name, by the file, to those that
/// its meshes have. Returns which TEXCOORD_n each is; at least two. Sets 0 and 1 keep their numbers, and
/// others take them where they are free, since those are the sets that cost least.
std::vector<int> assign_texcoord_sets(MaterialDescription& material);

}  // namespace vernier
