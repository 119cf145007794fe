// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/octree.h"

#include <tbb/concurrent_vector.h>

#include "core/base/parallel.h"
#include "scene/accel/two_level.h"
#include "vernier/error.h"

namespace vernier {
namespace {

constexpr unsigned leaf_size = 32;  ///< triangles a cell may hold undivided
constexpr unsigned max_depth = 20;
constexpr size_t parallel_size = 1 << 12;  ///< below this many triangles a task costs more than it saves

/// A cell. Its middle is computed in one way everywhere and inherited by its octants, so neighbors of any
/// size have the same plane between them and no ray passes between cells.
struct Cell {
  Vec3f lower, upper;

  Vec3f middle() const { return 0.5f * lower + 0.5f * upper; }
  Cell octant(unsigned i) const {
    const Vec3f m = middle();
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      const bool high = i >> axis & 1;
      cell.lower[axis] = high ? m[axis] : lower[axis];
      cell.upper[axis] = high ? upper[axis] : m[axis];
    }
    return cell;
  }
  bool can_divide() const {
    const Vec3f m = middle();
    const auto between = [&](int axis) { return lower[axis] < m[axis] && m[axis] < upper[axis]; };
    return between(0) || between(1) || between(2);
  }
};

/// Whether a triangle touches the cell, by the separating axis theorem: the axes of the cell, the triangle's
/// normal, and their edges' cross products (Akenine-Moeller 2001, "Fast 3D Triangle-Box Overlap Testing", JGT
/// 6(1)).
bool touches(const Cell& cell, const std::array<Vec3f, 3>& corners) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    if (low > cell.upper[axis] || high < cell.lower[axis]) return false;
  }
  const Vec3d center = (Vec3d(cell.lower) + Vec3d(cell.upper)) * 0.5, half = Vec3d(cell.upper) - center;
  const Vec3d v[3] = {Vec3d(corners[0]) - center, Vec3d(corners[1]) - center, Vec3d(corners[2]) - center};
  const Vec3d edges[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  const auto separates = [&](const Vec3d& axis) {
    const double p[3] = {dot(axis, v[0]), dot(axis, v[1]), dot(axis, v[2])};
    const double radius = dot(abs(axis), half);
    return std::min({p[0], p[1], p[2]}) > radius || std::max({p[0], p[1], p[2]}) < -radius;
  };
  if (separates(cross(edges[0], edges[1]))) return false;
  for (const Vec3d& e : edges)
    if (separates({0, -e.z, e.y}) || separates({e.z, 0, -e.x}) || separates({-e.y, e.x, 0})) return false;
  return true;
}

/// A cell while the tree is built in parallel.
struct Draft {
  std::vector<uint32_t> triangles;  ///< of a leaf
  std::array<const Draft*, 8> octants{};
  bool is_leaf = true;
};

class TriangleOctree {
 public:
  TriangleOctree() = default;
  explicit TriangleOctree(TriangleSet triangles);

  const Bounds& bounds() const { return bounds_; }
  size_t bytes() const {
    return nodes_.capacity() * sizeof(Node) + leaves_.capacity() * sizeof(Leaf) +
           blocks_.capacity() * sizeof(TriangleBlock);
  }

  template <bool ordered, typename Blocks>
  bool traverse(const Ray& ray, QueryCost* cost, Blocks&& blocks) const;

 private:
  static constexpr uint32_t leaf_flag = 1u << 31;
  using Node =
      std::array<uint32_t, 8>;  ///< by octant: index of a node, leaf_flag | index of a leaf, or 0: empty
  struct Leaf {
    uint32_t first, count;  ///< in blocks_
  };

  const Draft* build(const Cell& cell, std::vector<uint32_t> triangles, unsigned depth,
                     tbb::concurrent_vector<Draft>& drafts) const;
  uint32_t add(const Draft& draft);

  TriangleSet triangles_;
  Bounds bounds_;
  HugePageVector<Node> nodes_;
  HugePageVector<Leaf> leaves_;
  HugePageVector<TriangleBlock> blocks_;
};

TriangleOctree::TriangleOctree(TriangleSet triangles) : triangles_(std::move(triangles)) {
  std::vector<uint32_t> all;
  for (const BuildItem& item : triangles_.items()) {
    all.push_back(item.id);
    bounds_.add(item.box);
  }
  if (all.empty()) return;
  tbb::concurrent_vector<Draft> drafts;
  const Draft* root = build({bounds_.lower, bounds_.upper}, std::move(all), 0, drafts);
  if (const uint32_t ref = add(*root); ref & leaf_flag) nodes_.emplace_back().fill(ref);  // a root for it
  nodes_.shrink_to_fit();
  leaves_.shrink_to_fit();
  blocks_.shrink_to_fit();
}

const Draft* TriangleOctree::build(const Cell& cell, std::vector<uint32_t> triangles, unsigned depth,
                                   tbb::concurrent_vector<Draft>& drafts) const {
  Draft& draft = *drafts.emplace_back();
  if (triangles.size() > leaf_size && depth < max_depth && cell.can_divide()) {
    std::array<std::vector<uint32_t>, 8> octants;
    size_t total = 0;
    for (const uint32_t triangle : triangles) {
      const auto corners = triangles_.corners(triangle);
      for (unsigned i = 0; i < 8; ++i)
        if (touches(cell.octant(i), corners)) octants[i].push_back(triangle);
    }
    for (const auto& octant : octants) total += octant.size();
    // Where most triangles reach into half the octants, dividing multiplies them without telling them apart.
    if (total < 3 * triangles.size()) {
      draft.is_leaf = false;
      const auto build_octant = [&](size_t i) {
        if (!octants[i].empty())
          draft.octants[i] =
              build(cell.octant(static_cast<unsigned>(i)), std::move(octants[i]), depth + 1, drafts);
      };
      if (triangles.size() > parallel_size)
        parallel_for(8, build_octant);
      else
        for (size_t i = 0; i < 8; ++i) build_octant(i);
      return &draft;
    }
  }
  draft.triangles = std::move(triangles);
  return &draft;
}

uint32_t TriangleOctree::add(const Draft& draft) {
  if (draft.is_leaf) {
    const auto first = static_cast<uint32_t>(blocks_.size());
    const std::span<const uint32_t> triangles(draft.triangles);
    for (size_t i = 0; i < triangles.size(); i += TriangleBlock::lanes) {
      blocks_.push_back(triangles_.block(
          triangles.subspan(i, std::min<size_t>(TriangleBlock::lanes, triangles.size() - i))));
      triangles_.load(blocks_.back());
    }
    leaves_.push_back({first, static_cast<uint32_t>(blocks_.size()) - first});
    return leaf_flag | static_cast<uint32_t>(leaves_.size() - 1);
  }
  const auto index = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back({});
  for (unsigned i = 0; i < 8; ++i) {
    if (!draft.octants[i]) continue;
    const uint32_t ref = add(*draft.octants[i]);
    nodes_[index][i] = ref;
  }
  return index;
}

/// The boxes of a cell's octants.
Planes octant_planes(const Cell& cell) {
  const Mask8 high[3] = {
      {0, -1, 0, -1, 0, -1, 0, -1}, {0, 0, -1, -1, 0, 0, -1, -1}, {0, 0, 0, 0, -1, -1, -1, -1}};
  const Vec3f middle = cell.middle();
  Planes planes;
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 m = middle[axis] - Float8{};
    planes[axis] = high[axis] ? m : cell.lower[axis] - Float8{};
    planes[3 + axis] = high[axis] ? cell.upper[axis] - Float8{} : m;
  }
  return planes;
}

template <bool ordered, typename Blocks>
bool TriangleOctree::traverse(const Ray& ray, QueryCost* cost, Blocks&& blocks) const {
  struct Entry {
    uint32_t ref;
    float enters;
    Cell cell;
  };
  if (nodes_.empty()) return false;
  const SlabRay slab_ray(ray.origin, ray.direction, bounds_);
  std::array<Entry, (max_depth + 1) * 7 + 1> stack;
  unsigned size = 0;
  stack[size++] = {0, ray.t_min, {bounds_.lower, bounds_.upper}};
  while (size > 0) {
    const Entry top = stack[--size];
    if (top.enters > blocks.t_max()) continue;
    if (top.ref & leaf_flag) {
      const Leaf& leaf = leaves_[top.ref & ~leaf_flag];
      for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
        if (blocks.visit(blocks_[i])) return true;
      continue;
    }
    if (cost) ++cost->nodes;
    const Node& node = nodes_[top.ref];
    Float8 enters;
    const unsigned first = size;
    for (unsigned met = slab_ray.meets(octant_planes(top.cell), ray.t_min, blocks.t_max(), enters); met;
         met &= met - 1) {
      const auto i = lowest(met);
      if (node[i] == 0) continue;
      const Entry entry{node[i], enters[i], top.cell.octant(i)};
      unsigned place = size++;
      if (ordered)  // farthest deepest
        for (; place > first && stack[place - 1].enters < entry.enters; --place)
          stack[place] = stack[place - 1];
      stack[place] = entry;
    }
  }
  return false;
}

}  // namespace

std::unique_ptr<Accelerator> build_octree(const Geometry& geometry) {
  return std::make_unique<TwoLevel<TriangleOctree, WatertightTest>>(geometry);
}

}  // namespace vernier
