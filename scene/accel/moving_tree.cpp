// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/moving_tree.h"

#include "core/base/parallel.h"

namespace vernier {

MovingTree::MovingTree(MovingTriangles moving)
    : moments_(moving.moments), triangles_(std::move(moving.triangles)) {
  std::vector<BuildItem> items = triangles_.items();
  tree_ = WideTree(items, TriangleBlock::lanes);
  const std::vector<WideTree::Leaf> leaves = tree_.take_leaves();
  blocks_.resize(leaves.size() * moments_);
  parallel_for(leaves.size(), [&](size_t i) {
    std::array<uint32_t, TriangleBlock::lanes> ids;
    for (uint32_t k = 0; k < leaves[i].count; ++k) ids[k] = items[leaves[i].first + k].id;
    const TriangleBlock block = triangles_.block(std::span(ids).first(leaves[i].count));
    for (size_t m = 0; m < moments_; ++m) blocks_[i * moments_ + m] = block;
  });
  planes_.resize(tree_.nodes().size() * moments_);
  refit();
}

void MovingTree::refit() {
  parallel_for(blocks_.size(), [&](size_t i) { triangles_.load(blocks_[i], i % moments_); });
  for (size_t m = 0; m < moments_; ++m) {
    tree_.refit([&](uint32_t leaf) { return bounds_of(blocks_[leaf * moments_ + m]); });
    for (size_t node = 0; node < tree_.nodes().size(); ++node) {
      Planes& planes = planes_[node * moments_ + m];
      planes = tree_.nodes()[node].planes;
      // A place that is not used is met by no ray at any time: nor must it become infinity times zero.
      constexpr float far = std::numeric_limits<float>::max() / 4;
      for (unsigned slot = 0; slot < WideNode::width; ++slot)
        for (unsigned i = 0; i < planes.size() && !(tree_.nodes()[node].used >> slot & 1); ++i)
          planes[i][slot] = i < 3 ? far : -far;
    }
  }
  tree_.refit([&](uint32_t leaf) {
    Bounds box;
    for (size_t m = 0; m < moments_; ++m) box.add(bounds_of(blocks_[leaf * moments_ + m]));
    return box;
  });
}

size_t MovingTree::bytes() const {
  return tree_.bytes() + planes_.capacity() * sizeof(Planes) + blocks_.capacity() * sizeof(TriangleBlock);
}

}  // namespace vernier
