// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ImathMatrix.h>

#include <optional>
#include <vector>

#include "scene/import/document.h"
#include "scene/import/pose.h"
#include "vernier/transform.h"

namespace vernier {

/// Places of all nodes of a file, whether or not a scene shows them.
struct NodePlaces {
  std::vector<Imath::M44d> to_world;
  std::vector<int> shown;  ///< nodes of the scene, parents before children
  std::vector<int> top;    ///< by node: the one at the top of its tree
};

/// Accumulates the poses (one per node) down the hierarchy, iteratively. Throws Error(input) on a cycle, on a
/// node with two parents, and on a scene that lists a child.
NodePlaces place_nodes(const Document& document, const std::vector<NodePose>& poses);

/// Throws Error(input) about `place` when the matrix is not affine.
void check_affine(const Document& document, const Imath::M44d& matrix, const std::string& place);

/// None when the matrix does not fit in floats. Throws Error(input) about `place` when it is not affine.
std::optional<Transform> to_transform(const Document& document, const Imath::M44d& matrix,
                                      const std::string& place);

}  // namespace vernier
