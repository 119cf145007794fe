// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/bvh.h"

#include "core/base/parallel.h"

namespace vernier {

TriangleTree::TriangleTree(TriangleSet triangles) : triangles_(std::move(triangles)) {
  std::vector<BuildItem> items = triangles_.items();
  tree_ = WideTree(items, TriangleBlock::lanes);
  const std::vector<WideTree::Leaf> leaves = tree_.take_leaves();
  blocks_.resize(leaves.size());
  parallel_for(leaves.size(), [&](size_t i) {
    std::array<uint32_t, TriangleBlock::lanes> ids;
    for (uint32_t k = 0; k < leaves[i].count; ++k) ids[k] = items[leaves[i].first + k].id;
    blocks_[i] = triangles_.block(std::span(ids).first(leaves[i].count));
    triangles_.load(blocks_[i]);
  });
}

void TriangleTree::refit() {
  parallel_for(blocks_.size(), [&](size_t i) { triangles_.load(blocks_[i]); });
  tree_.refit([&](uint32_t leaf) { return bounds_of(blocks_[leaf]); });
}

std::unique_ptr<Accelerator> build_bvh(const Geometry& geometry) { return std::make_unique<Bvh>(geometry); }

std::unique_ptr<Accelerator> build_bvh_moeller(const Geometry& geometry) {
  return std::make_unique<TwoLevel<TriangleTree, MoellerTrumboreTest>>(geometry);
}

}  // namespace vernier
