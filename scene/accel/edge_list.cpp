// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/edge_list.h"

#include <cmath>
#include <limits>

#include "scene/accel/two_level.h"

namespace vernier {
namespace {

/// Beyond this a tree is quicker (docs/speed.md).
constexpr size_t most_triangles = 64;
/// Roundings to float, here and in intersect_watertight(), are each below 2^-24 of what the sizes of edges,
/// moments and rays allow. Some ten add up; this is six times as many.
constexpr double rounding_share = 0x1p-18;

double sum_of_sizes(const Vec3d& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

}  // namespace

EdgeList::EdgeList(TriangleSet triangles) {
  const std::vector<BuildItem> items = triangles.items();
  for (const BuildItem& item : items) bounds_.add(item.box);
  if (items.empty()) return;
  center_ = Vec3f((Vec3d(bounds_.lower) + Vec3d(bounds_.upper)) / 2.0);
  scale_ = float(std::ldexp(1.0, -std::ilogb(length(Vec3d(bounds_.upper) - Vec3d(center_)))));

  Block none{};
  none.offset = Float8{} + std::numeric_limits<float>::quiet_NaN();
  blocks_.assign((items.size() + lanes - 1) / lanes, none);
  for (size_t i = 0; i < items.size(); ++i) {
    const TriangleBlock ids = triangles.block(std::span(&items[i].id, 1));
    members_.push_back({triangles.corners(items[i].id), ids.instance[0], ids.primitive[0]});
    std::array<Vec3d, 3> p;
    for (size_t k = 0; k < 3; ++k) p[k] = (Vec3d(members_[i].corners[k]) - Vec3d(center_)) * double(scale_);

    Block& block = blocks_[i / lanes];
    const size_t lane = i % lanes;
    double sizes = 0;
    for (size_t edge = 0; edge < 3; ++edge) {
      const Vec3d &from = p[(edge + 1) % 3], &to = p[(edge + 2) % 3];
      const Vec3d direction = to - from, moment = cross(from, to);
      sizes += sum_of_sizes(direction) + sum_of_sizes(moment);
      for (int axis = 0; axis < 3; ++axis) {
        block.direction[edge][axis][lane] = float(direction[axis]);
        block.moment[edge][axis][lane] = float(moment[axis]);
      }
    }
    const Vec3d normal = cross(p[1] - p[0], p[2] - p[0]);
    for (int axis = 0; axis < 3; ++axis) block.normal[axis][lane] = float(normal[axis]);
    block.offset[lane] = float(dot(normal, p[0]));
    block.rounding[lane] = float(sizes * rounding_share);
  }
}

void EdgeList::rescale(const Ray& ray, Line& line) const {
  const int exponent = -std::ilogb(max_component(abs(ray.direction)));
  for (int axis = 0; axis < 3; ++axis) line.direction[axis] = std::ldexp(ray.direction[axis], exponent);
  const int back = std::ilogb(scale_) - exponent;
  line.t_min = std::ldexp(line.t_min, back);
  line.t_max = std::ldexp(line.t_max, back);
}

bool suits_edge_list(const Geometry& geometry) {
  size_t count = 0;
  for (const GeometryInstance& instance : geometry.instances) {
    const GeometryMesh& mesh = geometry.meshes[instance.mesh];
    if (mesh.moves() || !instance.to_world.is_identity()) return false;
    count += mesh.triangles.size();
    if (count > most_triangles) return false;
  }
  return true;
}

std::unique_ptr<Accelerator> build_edge_list(const Geometry& geometry) {
  return std::make_unique<TwoLevel<EdgeList, WatertightTest>>(geometry);
}

}  // namespace vernier
