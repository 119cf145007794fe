// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh_extent.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/math/rounding.h"

namespace vernier {
namespace {

constexpr size_t triangles_a_run = 16, children = 8;

double reach(const Bounds& box, const Vec3d& direction) {
  if (box.empty()) return -std::numeric_limits<double>::infinity();
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    sum += std::max(box.lower[axis] * direction[axis], box.upper[axis] * direction[axis]);
  return sum;
}

/// Boxes about `size` boxes each of the level below.
template <typename BoxAt>
std::vector<Bounds> box_up(size_t count, size_t size, const BoxAt& box_at) {
  std::vector<Bounds> boxes((count + size - 1) / size);
  parallel_for(boxes.size(), [&](size_t i) {
    for (size_t k = i * size; k < std::min(count, (i + 1) * size); ++k) box_at(k, boxes[i]);
  });
  return boxes;
}

}  // namespace

/// Branch and bound along one direction. The visitor has `best()`, the most that it has found so far along
/// the direction in the world, and is shown corners in the mesh, with their place in the order of all, that
/// may reach as far.
template <typename Visitor>
class MeshExtent::Search {
 public:
  Search(const MeshExtent& extent, const Transform& to_world, const Vec3f& direction, Visitor& visitor)
      : extent_(extent), visitor_(visitor) {
    const Vec3d d(direction);
    along_ = {dot(Vec3d(to_world.x), d), dot(Vec3d(to_world.y), d), dot(Vec3d(to_world.z), d)};
    const Bounds& all = extent.levels_.back()[0];
    const Vec3f size = to_world.absolute_point(max(abs(all.lower), abs(all.upper)), 1);
    // With what rounding may add to a corner that is placed in float and measured along the direction.
    offset_ =
        dot(Vec3d(to_world.origin), d) + 2 * double(gamma_bound(8)) * dot(Vec3d(size), Vec3d(abs(direction)));
    // Beyond the range of float nothing is known beforehand.
    if (!std::isfinite(offset_)) offset_ = std::numeric_limits<double>::infinity();
  }

  /// The run that reaches farthest goes first: most others then need no look.
  void run() {
    const size_t top = extent_.levels_.size() - 1;
    size_t farthest = 0;
    for (size_t level = top; level-- > 0;) {
      const auto& boxes = extent_.levels_[level];
      const size_t first = farthest * children;
      farthest = first;
      for (size_t i = first; i < std::min(boxes.size(), first + children); ++i)
        if (reach(boxes[i], along_) > reach(boxes[farthest], along_)) farthest = i;
    }
    look(farthest);
    scan(top, 0, 1);
  }

 private:
  void scan(size_t level, size_t begin, size_t end) {
    const auto& boxes = extent_.levels_[level];
    for (size_t i = begin; i < std::min(boxes.size(), end); ++i) {
      if (reach(boxes[i], along_) + offset_ < visitor_.best()) continue;
      if (level == 0)
        look(i);
      else
        scan(level - 1, i * children, (i + 1) * children);
    }
  }

  void look(size_t run) {
    const size_t first = run * triangles_a_run;
    for (size_t i = first; i < std::min(extent_.triangles_.size(), first + triangles_a_run); ++i)
      for (size_t k = 0; k < 3; ++k) {
        const Vec3f& p = extent_.positions_[extent_.triangles_[i][k]];
        if (dot(along_, Vec3d(p)) + offset_ >= visitor_.best()) visitor_.look(p, 3 * i + k);
      }
  }

  const MeshExtent& extent_;
  Visitor& visitor_;
  Vec3d along_;
  double offset_;
};

MeshExtent::MeshExtent(std::span<const Vec3f> positions, std::span<const Triangle> triangles)
    : positions_(positions), triangles_(triangles) {
  if (triangles.empty()) return;
  levels_.push_back(box_up(triangles.size(), triangles_a_run, [&](size_t k, Bounds& box) {
    for (const uint32_t vertex : triangles[k])
      if (is_finite(positions[vertex])) box.add(positions[vertex]);
  }));
  while (levels_.back().size() > 1) {
    const auto& below = levels_.back();
    levels_.push_back(box_up(below.size(), children, [&](size_t k, Bounds& box) { box.add(below[k]); }));
  }
}

Bounds MeshExtent::bounds(const Transform& to_world) const {
  struct Visitor {
    const Transform& to_world;
    int axis = 0;
    bool upper = false;
    Bounds box{};

    double best() const { return upper ? box.upper[axis] : -box.lower[axis]; }
    void look(const Vec3f& corner, size_t) {
      if (const Vec3f p = to_world.point(corner); is_finite(p)) box.add(p);
    }
  };
  if (levels_.empty()) return {};
  Visitor visitor{to_world};
  for (visitor.axis = 0; visitor.axis < 3; ++visitor.axis)
    for (const bool upper : {false, true}) {
      visitor.upper = upper;
      Vec3f direction(0, 0, 0);
      direction[visitor.axis] = upper ? 1 : -1;
      Search(*this, to_world, direction, visitor).run();
    }
  return visitor.box;
}

FarthestCorner MeshExtent::farthest(const Transform& to_world, const Vec3f& direction) const {
  struct Visitor {
    const Transform& to_world;
    const Vec3f& direction;
    FarthestCorner found{};
    size_t corner = 0;  ///< its place in the order of all

    double best() const { return found.along; }
    void look(const Vec3f& local, size_t place) {
      const Vec3f p = to_world.point(local);
      const float along = dot(p, direction);
      if (!is_finite(p) || along < found.along || (along == found.along && place >= corner)) return;
      found = {p, along};
      corner = place;
    }
  };
  Visitor visitor{to_world, direction};
  if (!levels_.empty()) Search(*this, to_world, direction, visitor).run();
  return visitor.found;
}

}  // namespace vernier
