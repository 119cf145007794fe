// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/wide_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/concurrent_vector.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "vernier/error.h"

namespace vernier {

WideNode::WideNode() {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (unsigned i = 0; i < planes.size(); ++i) planes[i] = (i < 3 ? infinity : -infinity) - Float8{};
}

void WideNode::set_box(unsigned slot, const Bounds& box) {
  for (int axis = 0; axis < 3; ++axis) {
    planes[axis][slot] = box.lower[axis];
    planes[3 + axis][slot] = box.upper[axis];
  }
}

Bounds WideNode::box(unsigned slot) const {
  return {{planes[0][slot], planes[1][slot], planes[2][slot]},
          {planes[3][slot], planes[4][slot], planes[5][slot]}};
}

Bounds WideNode::bounds() const {
  Bounds all;
  for (unsigned slot = 0; slot < width; ++slot) all.add(box(slot));
  return all;
}

namespace {

constexpr unsigned most_bins = 16;
constexpr size_t parallel_size = 1 << 14;  ///< below this many items a task costs more than it saves

/// parallel_reduce over [0, size), without a task where there is too little to share.
template <typename Value, typename Extend, typename Join>
Value reduce(size_t size, const Value& identity, const Extend& extend, const Join& join) {
  const tbb::blocked_range<size_t> all(0, size, parallel_size);
  return size <= parallel_size ? extend(all, identity) : tbb::parallel_reduce(all, identity, extend, join);
}

/// Some of the items, together in memory.
struct Range {
  std::span<BuildItem> items;
  Bounds box, centroids;  ///< of the items' boxes; of their centres
  unsigned depth = 0;     ///< number of splits that led here
};

Vec3f centroid(const Bounds& box) { return 0.5f * box.lower + 0.5f * box.upper; }

void measure(Range& range) {
  struct Boxes {
    Bounds box, centroids;
  };
  const auto extend = [&](const tbb::blocked_range<size_t>& part, Boxes boxes) {
    for (size_t i = part.begin(); i < part.end(); ++i) {
      boxes.box.add(range.items[i].box);
      boxes.centroids.add(centroid(range.items[i].box));
    }
    return boxes;
  };
  const auto join = [](Boxes a, const Boxes& b) {
    a.box.add(b.box);
    a.centroids.add(b.centroids);
    return a;
  };
  const Boxes all = reduce(range.items.size(), Boxes{}, extend, join);
  range.box = all.box;
  range.centroids = all.centroids;
}

struct Bin {
  Bounds box;
  size_t count = 0;

  void add(const Bin& b) { box.add(b.box), count += b.count; }
};
using Bins = std::array<std::array<Bin, most_bins>, 3>;

/// Which bin a centre falls in, along each axis that has an extent. Few items need few bins, and most splits
/// are of few items.
struct Binning {
  unsigned bin_count;
  Vec3f lower, scale;

  explicit Binning(const Range& range)
      : bin_count(static_cast<unsigned>(std::min<size_t>(most_bins, 4 + range.items.size() / 8))),
        lower(range.centroids.lower) {
    for (int axis = 0; axis < 3; ++axis) {
      scale[axis] = static_cast<float>(bin_count) / (range.centroids.upper[axis] - lower[axis]);
      if (!std::isfinite(scale[axis])) scale[axis] = 0;
    }
  }
  unsigned bin(const Vec3f& c, int axis) const {
    return std::min(static_cast<unsigned>((c[axis] - lower[axis]) * scale[axis]), bin_count - 1);
  }
};

Bins fill_bins(std::span<const BuildItem> items, const Binning& binning) {
  const auto fill = [&](const tbb::blocked_range<size_t>& part, Bins bins) {
    for (size_t i = part.begin(); i < part.end(); ++i) {
      const Vec3f c = centroid(items[i].box);
      for (int axis = 0; axis < 3; ++axis) bins[axis][binning.bin(c, axis)].add({items[i].box, 1});
    }
    return bins;
  };
  const auto join = [](Bins a, const Bins& b) {
    for (int axis = 0; axis < 3; ++axis)
      for (unsigned i = 0; i < most_bins; ++i) a[axis][i].add(b[axis][i]);
    return a;
  };
  return reduce(items.size(), Bins{}, fill, join);
}

struct Split {
  int axis = -1;
  unsigned bin = 0;  ///< first bin of the right side
  float cost = std::numeric_limits<float>::infinity();
};

Split best_split(const Bins& bins, unsigned bin_count, unsigned leaf_size) {
  const auto cost = [&](const Bin& side) {
    const size_t leaves = (side.count + leaf_size - 1) / leaf_size;
    return side.box.half_area() * static_cast<float>(leaves);
  };
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<float, most_bins> left_cost{};
    Bin left, right;
    for (unsigned i = 0; i + 1 < bin_count; ++i) {
      left.add(bins[axis][i]);
      left_cost[i + 1] = left.count ? cost(left) : std::numeric_limits<float>::infinity();
    }
    for (unsigned i = bin_count - 1; i > 0; --i) {
      right.add(bins[axis][i]);
      const float total = left_cost[i] + cost(right);
      if (right.count && total < best.cost) best = {axis, i, total};
    }
  }
  return best;
}

/// The items in two by the surface area heuristic; in the middle of the longest axis where that finds no
/// plane (centres that coincide or overflow) or the tree gets too deep.
std::pair<Range, Range> split(Range& range, unsigned leaf_size) {
  constexpr unsigned sah_depth = 64;  // log2 of the number of items may follow below
  const Binning binning(range);
  Split best;
  if (range.depth < sah_depth)
    best = best_split(fill_bins(range.items, binning), binning.bin_count, leaf_size);
  size_t middle = range.items.size() / 2;
  if (best.axis >= 0) {
    const auto is_left = [&](const BuildItem& item) {
      return binning.bin(centroid(item.box), best.axis) < best.bin;
    };
    middle = static_cast<size_t>(std::partition(range.items.begin(), range.items.end(), is_left) -
                                 range.items.begin());
  } else {
    const Vec3f extent = range.centroids.upper - range.centroids.lower;
    const int axis = extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
    const auto before = [&](const BuildItem& a, const BuildItem& b) {
      return std::pair(centroid(a.box)[axis], a.id) < std::pair(centroid(b.box)[axis], b.id);
    };
    std::nth_element(range.items.begin(), range.items.begin() + static_cast<ptrdiff_t>(middle),
                     range.items.end(), before);
  }
  std::pair<Range, Range> sides{{range.items.first(middle), {}, {}, range.depth + 1},
                                {range.items.subspan(middle), {}, {}, range.depth + 1}};
  measure(sides.first);
  measure(sides.second);
  return sides;
}

/// A node of the binary tree that the wide one is made from.
struct BinaryNode {
  Range range;
  BinaryNode *left = nullptr, *right = nullptr;  ///< none for a leaf
  /// cost[i]: least sum of the areas of the wide nodes needed when this subtree fills at most i + 1 places of
  /// a wide node; places_left[i]: how many of them its left side gets then, 0 if it is better to fill fewer.
  std::array<float, WideNode::width> cost{};
  std::array<uint8_t, WideNode::width> places_left{};
};
using BinaryTree = tbb::concurrent_vector<BinaryNode>;  // elements stay where they are

/// Which subtrees become the children of which wide node, by dynamic programming from the leaves up (Ylitie,
/// Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 3.1; here
/// all leaves are given, so that only nodes cost).
void choose_places(BinaryNode& node) {
  for (unsigned places = 2; places <= WideNode::width; ++places) {
    float& best = node.cost[places - 1];
    best = std::numeric_limits<float>::infinity();
    for (unsigned left = 1; left < places; ++left) {
      const float cost = node.left->cost[left - 1] + node.right->cost[places - left - 1];
      if (cost < best) {
        best = cost;
        node.places_left[places - 1] = static_cast<uint8_t>(left);
      }
    }
  }
  // One place: a wide node of its own.
  node.cost[0] = node.cost[WideNode::width - 1] + node.range.box.half_area();
  const uint8_t left_of_own_node = node.places_left[WideNode::width - 1];
  for (unsigned i = 1; i < WideNode::width; ++i) {
    if (node.cost[i] < node.cost[i - 1]) continue;
    node.cost[i] = node.cost[i - 1];
    node.places_left[i] = 0;
  }
  node.places_left[0] = left_of_own_node;
}

BinaryNode* build(Range range, unsigned leaf_size, BinaryTree& tree) {
  BinaryNode& node = *tree.emplace_back();
  node.range = range;
  if (range.items.size() <= leaf_size) return &node;
  auto [left, right] = split(range, leaf_size);
  if (range.items.size() > parallel_size) {
    tbb::parallel_invoke([&, l = left] { node.left = build(l, leaf_size, tree); },
                         [&, r = right] { node.right = build(r, leaf_size, tree); });
  } else {
    node.left = build(left, leaf_size, tree);
    node.right = build(right, leaf_size, tree);
  }
  choose_places(node);
  return &node;
}

/// The subtrees that fill at most `places` places on behalf of `node`.
void gather_children(const BinaryNode& node, unsigned places, std::vector<const BinaryNode*>& children) {
  while (places > 1 && node.places_left[places - 1] == 0) --places;
  if (places == 1) {
    children.push_back(&node);
    return;
  }
  gather_children(*node.left, node.places_left[places - 1], children);
  gather_children(*node.right, places - node.places_left[places - 1], children);
}

}  // namespace

WideTree::WideTree(std::span<BuildItem> items, unsigned leaf_size) {
  if (items.empty()) return;
  if (items.size() >= std::numeric_limits<uint32_t>::max())
    throw Error(ErrorKind::input, "more than 2^32 triangles in one mesh; split the scene");
  Range all{items, {}, {}, 0};
  measure(all);
  bounds_ = all.box;
  BinaryTree tree;
  const BinaryNode* root = build(all, leaf_size, tree);

  // Depth first, so that a subtree is together in memory and the layout does not depend on the threads.
  const auto add_leaf = [&](const BinaryNode& leaf) {
    leaves_.push_back({static_cast<uint32_t>(leaf.range.items.data() - items.data()),
                       static_cast<uint32_t>(leaf.range.items.size())});
    return static_cast<uint32_t>(leaves_.size() - 1);
  };
  const auto add_node = [&](const auto& self, const BinaryNode& node) -> uint32_t {
    std::vector<const BinaryNode*> children;
    if (node.left) {
      gather_children(*node.left, node.places_left[0], children);
      gather_children(*node.right, WideNode::width - node.places_left[0], children);
    } else {
      children.push_back(&node);
    }
    const auto index = static_cast<uint32_t>(nodes_.size());
    nodes_.emplace_back();
    for (unsigned slot = 0; slot < children.size(); ++slot) {
      const BinaryNode& child = *children[slot];
      const uint32_t place = child.left ? self(self, child) : add_leaf(child);
      WideNode& wide = nodes_[index];
      wide.set_box(slot, child.range.box);
      wide.child[slot] = place;
      wide.used |= static_cast<uint8_t>(1u << slot);
      if (!child.left) wide.leaf |= static_cast<uint8_t>(1u << slot);
    }
    return index;
  };
  add_node(add_node, *root);
  nodes_.shrink_to_fit();
  leaf_count_ = leaves_.size();
}

}  // namespace vernier
