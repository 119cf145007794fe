// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/brute_force.h"

#include "scene/accel/two_level.h"

namespace vernier {
namespace {

class TriangleList {
 public:
  TriangleList() = default;
  explicit TriangleList(TriangleSet triangles) {
    const std::vector<BuildItem> items = triangles.items();
    for (size_t first = 0; first < items.size(); first += TriangleBlock::lanes) {
      std::vector<uint32_t> ids;
      for (size_t i = first; i < std::min(first + TriangleBlock::lanes, items.size()); ++i) {
        ids.push_back(items[i].id);
        bounds_.add(items[i].box);
      }
      blocks_.push_back(triangles.block(ids));
    }
  }

  const Bounds& bounds() const { return bounds_; }
  size_t bytes() const { return blocks_.capacity() * sizeof(TriangleBlock); }

  template <bool ordered, typename Blocks>
  bool traverse(const Ray&, QueryCost*, Blocks&& blocks) const {
    for (const TriangleBlock& block : blocks_)
      if (blocks.visit(block)) return true;
    return false;
  }

 private:
  std::vector<TriangleBlock> blocks_;
  Bounds bounds_;
};

}  // namespace

std::unique_ptr<Accelerator> build_brute_force(const Geometry& geometry) {
  return std::make_unique<TwoLevel<TriangleList, WatertightTest>>(geometry);
}

}  // namespace vernier
