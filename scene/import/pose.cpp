// SPDX-License-Identifier: Apache-2.0
#include "scene/import/pose.h"

#include <fmt/format.h>

#include <cmath>

namespace vernier {
namespace {

bool is_visible(const FileNode& node) {
  const auto visibility = node.extensions.find("KHR_node_visibility");
  if (visibility == node.extensions.end() || !visibility->second.Has("visible")) return true;
  return visibility->second.Get("visible").Get<bool>();
}

}  // namespace

Imath::M44d NodePose::to_parent() const {
  if (matrix) return *matrix;
  Imath::M44d m = rotation.toMatrix44();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) m[row][column] *= scale[row];
    m[3][row] = translation[row];
  }
  return m;
}

std::vector<NodePose> rest_pose(const Document& document, std::vector<Notice>& notices) {
  size_t scaled = 0;
  std::vector<NodePose> poses;
  poses.reserve(document.nodes().size());
  for (const FileNode& node : document.nodes()) {
    NodePose& pose = poses.emplace_back();
    const auto& r = node.rotation;
    if (node.matrix.size() == 16) {
      // Columns in the file are rows here.
      Imath::M44d matrix;
      for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[size_t(i)];
      pose.matrix = std::make_shared<const Imath::M44d>(matrix);
    }
    if (r.size() == 4) {
      const Imath::Quatd rotation(r[3], r[0], r[1], r[2]);
      if (std::abs(rotation.length() - 1) > 0.01) ++scaled;
      pose.rotation = rotation.normalized();
    }
    for (int i = 0; i < 3; ++i) {
      if (node.translation.size() == 3) pose.translation[i] = node.translation[size_t(i)];
      if (node.scale.size() == 3) pose.scale[i] = node.scale[size_t(i)];
    }
    pose.weights = node.weights;
    pose.visible = is_visible(node);
  }
  if (scaled)
    notices.push_back({Notice::Severity::warning, "/nodes",
                       fmt::format("{} rotations were not of unit length and were scaled", scaled)});
  return poses;
}

}  // namespace vernier
