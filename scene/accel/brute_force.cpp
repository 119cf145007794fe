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
      triangles.load(blocks_.back());
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

class MovingList {
 public:
  explicit MovingList(MovingTriangles moving) : moments_(moving.moments) {
    const std::vector<BuildItem> items = moving.triangles.items();
    for (size_t first = 0; first < items.size(); first += TriangleBlock::lanes) {
      std::vector<uint32_t> ids;
      for (size_t i = first; i < std::min(first + TriangleBlock::lanes, items.size()); ++i)
        ids.push_back(items[i].id);
      for (size_t moment = 0; moment < moments_; ++moment) {
        blocks_.push_back(moving.triangles.block(ids));
        moving.triangles.load(blocks_.back(), moment);
      }
    }
  }

  size_t bytes() const { return blocks_.capacity() * sizeof(TriangleBlock); }

  template <bool ordered, typename Blocks>
  bool traverse(const Ray& ray, QueryCost*, Blocks&& blocks) const {
    const MomentPair time = moments_around(ray.time, moments_);
    for (size_t i = 0; i < blocks_.size(); i += moments_)
      if (blocks.visit(block_between(&blocks_[i], time))) return true;
    return false;
  }

 private:
  size_t moments_;
  std::vector<TriangleBlock> blocks_;  ///< by group of four and moment
};

}  // namespace

std::unique_ptr<Accelerator> build_brute_force(const Geometry& geometry) {
  return std::make_unique<TwoLevel<TriangleList, WatertightTest, MovingList>>(geometry);
}

}  // namespace vernier
