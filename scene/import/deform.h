#pragma once

#include <ImathMatrix.h>

#include <vector>

#include "scene/description.h"
#include "scene/import/document.h"
#include "scene/import/primitive_data.h"

namespace vernier {

/// Adds the primitive's morph targets, each times its weight, to the mesh's attributes. Normals and tangents
/// are of unit length again afterwards. Throws Error(input).
void morph(const PrimitiveData& data, const std::vector<double>& weights, MeshDescription& mesh);

/// Matrices that move vertices bound to each joint of a skin into the world (row vectors). Throws
/// Error(input).
std::vector<Imath::M44d> joint_matrices(const Document& document, int skin,
                                        const std::vector<Imath::M44d>& node_to_world);

/// Moves the mesh into the world by its JOINTS_n and WEIGHTS_n (glTF 2.0, 3.7.3.3). Throws Error(input).
void skin(const PrimitiveData& data, const std::vector<Imath::M44d>& joints, MeshDescription& mesh);

}  // namespace vernier
