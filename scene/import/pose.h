// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ImathMatrix.h>
#include <ImathQuat.h>

#include <memory>
#include <string>
#include <vector>

#include "scene/import/document.h"
#include "vernier/error.h"

namespace vernier {

/// Where a node is in its parent, how far its mesh is morphed, and whether it shows.
struct NodePose {
  std::shared_ptr<const Imath::M44d> matrix;  ///< instead of the three below; mostly null
  Imath::V3d translation{0, 0, 0}, scale{1, 1, 1};
  Imath::Quatd rotation;        ///< unit
  std::vector<double> weights;  ///< of morph targets; empty: the mesh's own
  bool visible = true;          ///< KHR_node_visibility: whether it and what is below it is shown

  /// As Imath multiplies: row vectors, so the rows are what the axes and the origin map to.
  Imath::M44d to_parent() const;
};

/// Poses of all nodes as the file gives them. Rotations that are not of unit length are scaled, which is
/// noticed.
std::vector<NodePose> rest_pose(const Document& document, std::vector<Notice>& notices);

/// Sets what animations animate to its values at `time` seconds; before its first key and after its last
/// those hold, which is noticed. `wanted` is ImportOptions::animation; where several animations set one
/// property the last in the file's order does. What belongs to no node goes to `values`. Throws Error(usage)
/// when there is no such animation.
void pose_by_animations(const Document& document, const std::string& wanted, double time,
                        std::vector<NodePose>& poses, std::vector<PropertyValue>& values,
                        std::vector<Notice>& notices);

}  // namespace vernier
