// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/scene.h"

namespace vernier {

/// Derives tangents from the texture coordinates that `map` is read with, as MikkTSpace does (Mikkelsen 2008,
/// "Simulation of Wrinkled Surfaces Revisited", and its reference implementation), which is what normal maps
/// are baked for and glTF 2.0, 3.7.2.1 asks for. Handedness is glTF's: bitangents point up the picture, v
/// points down. Vertices where tangents differ between triangles are split; a mesh without normals gets its
/// triangles' own.
void derive_tangents(MeshDescription& mesh, const TextureUse& map);

}  // namespace vernier
