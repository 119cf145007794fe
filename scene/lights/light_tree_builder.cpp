// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/light_tree_builder.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace vernier {
namespace {

constexpr size_t width = LightNode::width;

/// As many lights are worth tasks of their own.
constexpr size_t least_parallel = 16'384;

using Ranges = std::vector<LightRange>;

/// Splits the range about which least is known; false: all are lights.
bool split_one(Ranges& ranges) {
  auto widest = ranges.end();
  for (auto range = ranges.begin(); range != ranges.end(); ++range)
    if (range->size() > 1 && (widest == ranges.end() || range->unknown > widest->unknown)) widest = range;
  if (widest == ranges.end()) return false;
  const auto [below, above] = split(*widest);
  *widest = below;
  ranges.push_back(above);
  return true;
}

/// The lights and groups that one node holds: what fits it as it is, and else what is split until it is full.
/// To split first what does not fit a node whole would leave a third fewer nodes, but cost up to a third of
/// the variance of a choice among lights that face all ways.
Ranges members(const LightRange& root) {
  Ranges ranges;
  ranges.reserve(width);
  if (root.size() <= width) {
    for (size_t i = 0; i < root.size(); ++i) ranges.push_back({root.lights.subspan(i, 1), {}});
    return ranges;
  }
  ranges.push_back(root);
  while (ranges.size() < width && split_one(ranges)) {
  }
  return ranges;
}

void link(std::vector<LightNode>& nodes, size_t parent, size_t slot, size_t child) {
  const auto apart = uint32_t(child - parent);
  nodes[parent].set_node(int(slot), apart);
  nodes[child].set_parent(apart, int(slot));
}

/// Appends the node of the range and those below it.
void append(std::vector<LightNode>& nodes, const LightRange& root) {
  const size_t index = nodes.size();
  nodes.emplace_back();
  const Ranges ranges = members(root);
  for (size_t i = 0; i < ranges.size(); ++i) {
    nodes[index].set(int(i), bounds_of(ranges[i]));
    if (ranges[i].size() == 1) nodes[index].set_light(int(i), ranges[i].lights[0].light);
  }
  const auto is_node = [&](size_t i) { return ranges[i].size() > 1; };
  if (root.size() < least_parallel) {
    for (size_t i = 0; i < ranges.size(); ++i) {
      if (!is_node(i)) continue;
      const size_t child = nodes.size();
      append(nodes, ranges[i]);
      link(nodes, index, i, child);
    }
    return;
  }
  std::vector<std::vector<LightNode>> below(ranges.size());
  parallel_for(ranges.size(), [&](size_t i) {
    if (is_node(i)) append(below[i], ranges[i]);
  });
  size_t count = nodes.size();
  for (const auto& part : below) count += part.size();
  nodes.reserve(count);
  for (size_t i = 0; i < ranges.size(); ++i) {
    if (!is_node(i)) continue;
    const size_t child = nodes.size();
    nodes.insert(nodes.end(), below[i].begin(), below[i].end());
    below[i] = {};
    link(nodes, index, i, child);
  }
}

}  // namespace

std::vector<LightNode> build_light_nodes(std::span<PlacedLight> lights) {
  std::vector<LightNode> nodes;
  append(nodes, range_of(lights));
  nodes.shrink_to_fit();
  return nodes;
}

}  // namespace vernier
