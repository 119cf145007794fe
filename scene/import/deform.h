// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ImathMatrix.h>

#include <array>
#include <vector>

#include "scene/import/document.h"
#include "scene/import/primitive_data.h"
#include "vernier/scene.h"

namespace vernier {

/// Adds the primitive's morph targets, each times its weight, to the mesh's attributes. `texcoords`: the n of
/// the TEXCOORD_n that are the mesh's sets. Afterwards normals and tangents are of unit length again and
/// morphed colours in [0, 1] (glTF 2.0, 3.7.2.2). Throws Error(input).
void morph(const PrimitiveData& data, const std::vector<double>& weights, const std::vector<int>& texcoords,
           MeshDescription& mesh);

/// Matrices that move vertices bound to each joint of a skin into the world (row vectors). Throws
/// Error(input).
std::vector<Imath::M44d> joint_matrices(const Document& document, int skin,
                                        const std::vector<Imath::M44d>& node_to_world);

/// Moves the mesh into the world by its JOINTS_n and WEIGHTS_n (glTF 2.0, 3.7.3.3). Throws Error(input).
void skin(const PrimitiveData& data, const std::vector<Imath::M44d>& joints, MeshDescription& mesh);

}  // namespace vernier
