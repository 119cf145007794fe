// SPDX-License-Identifier: Apache-2.0
#include "scene/import/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vernier {
namespace {

using Imath::M44d;

/// Parent of each node, -1 for roots.
std::vector<int> parents_of(const Document& document) {
  const auto& nodes = document.nodes();
  std::vector<int> parents(nodes.size(), -1);
  for (size_t i = 0; i < nodes.size(); ++i)
    for (size_t c = 0; c < nodes[i].children.size(); ++c) {
      int& parent = parents[size_t(nodes[i].children[c])];
      if (parent >= 0)
        document.fail(fmt::format("/nodes/{}/children/{}", i, c),
                      fmt::format("node {} has two parents, {} and {}; nodes must form trees",
                                  nodes[i].children[c], parent, i));
      parent = int(i);
    }
  return parents;
}

/// The scene's roots: of the default scene, else the first, else all roots.
std::vector<int> scene_roots(const Document& document, const std::vector<int>& parents) {
  const auto& model = document.model();
  if (model.scenes.empty()) {
    std::vector<int> roots;
    for (size_t i = 0; i < parents.size(); ++i)
      if (parents[i] < 0) roots.push_back(int(i));
    return roots;
  }
  const int scene = std::max(model.defaultScene, 0);
  const auto& roots = model.scenes[size_t(scene)].nodes;
  std::vector<bool> listed(parents.size(), false);
  for (size_t i = 0; i < roots.size(); ++i) {
    const std::string place = fmt::format("/scenes/{}/nodes/{}", scene, i);
    if (listed[size_t(roots[i])]) document.fail(place, fmt::format("node {} is listed twice", roots[i]));
    if (parents[size_t(roots[i])] >= 0)
      document.fail(place, fmt::format("node {} is a child of node {}; a scene lists root nodes only",
                                       roots[i], parents[size_t(roots[i])]));
    listed[size_t(roots[i])] = true;
  }
  return roots;
}

}  // namespace

NodePlaces place_nodes(const Document& document, const std::vector<NodePose>& poses) {
  const auto& nodes = document.nodes();
  const std::vector<int> parents = parents_of(document);
  NodePlaces places;
  places.to_world.reserve(poses.size());
  for (const auto& pose : poses) places.to_world.push_back(pose.to_parent());
  places.top.resize(nodes.size());
  std::vector<bool> reached(nodes.size(), false);
  std::vector<int> pending;
  for (size_t root = 0; root < nodes.size(); ++root) {
    if (parents[root] >= 0) continue;
    pending.push_back(int(root));
    while (!pending.empty()) {
      const size_t node = size_t(pending.back());
      pending.pop_back();
      reached[node] = true;
      places.top[node] = int(root);
      for (const int child : nodes[node].children) {
        places.to_world[size_t(child)] *= places.to_world[node];
        pending.push_back(child);
      }
    }
  }
  for (size_t i = 0; i < nodes.size(); ++i)
    if (!reached[i])
      document.fail(fmt::format("/nodes/{}", i), "the node is its own ancestor; nodes must form trees");

  const std::vector<int> roots = scene_roots(document, parents);
  pending.assign(roots.rbegin(), roots.rend());
  while (!pending.empty()) {
    const int node = pending.back();
    pending.pop_back();
    if (!poses[size_t(node)].visible) continue;
    places.shown.push_back(node);
    const auto& children = nodes[size_t(node)].children;
    pending.insert(pending.end(), children.rbegin(), children.rend());
  }
  return places;
}

void check_affine(const Document& document, const M44d& m, const std::string& place) {
  for (int row = 0; row < 4; ++row)
    if (std::abs(m[row][3] - (row == 3 ? 1 : 0)) > 1e-6)
      document.fail(place, "the transform is not affine: the last row of its matrix must be 0 0 0 1");
}

std::optional<Transform> to_transform(const Document& document, const M44d& m, const std::string& place) {
  check_affine(document, m, place);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column)
      if (!(std::abs(m[row][column]) <= double(std::numeric_limits<float>::max()))) return std::nullopt;
  const auto row = [&](int i) { return Vec3f(Vec3d(m[i][0], m[i][1], m[i][2])); };
  return Transform{row(0), row(1), row(2), row(3)};
}

}  // namespace vernier
