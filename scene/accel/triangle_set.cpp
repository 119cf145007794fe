// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/triangle_set.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "core/base/parallel.h"
#include "core/math/moments.h"
#include "scene/accel/triangle.h"
#include "vernier/error.h"

namespace vernier {
namespace {

Vec3f middle_position(const GeometryMesh& mesh, uint32_t vertex) {
  if (!mesh.moves()) return mesh.positions[vertex];
  const auto [first, part] = moments_around(middle_of_shutter, mesh.moments.size());
  return between(mesh.moments[first][vertex], mesh.moments[first + 1][vertex], part);
}

}  // namespace

void TriangleSet::add(const GeometryMesh& mesh, uint32_t instance) {
  if (mesh.triangles.size() > std::numeric_limits<uint32_t>::max() - size_)
    throw Error(ErrorKind::input, "more than 2^32 triangles; this accelerator cannot number them");
  parts_.push_back({mesh, instance, size_});
  size_ += static_cast<uint32_t>(mesh.triangles.size());
}

const TriangleSet::Part& TriangleSet::part_of(uint32_t triangle) const {
  const auto first_is_beyond = [](uint32_t t, const Part& part) { return t < part.first; };
  return *std::prev(std::upper_bound(parts_.begin(), parts_.end(), triangle, first_is_beyond));
}

std::array<Vec3f, 3> TriangleSet::corners(uint32_t triangle) const {
  const Part& part = part_of(triangle);
  const Triangle& t = part.mesh.triangles[triangle - part.first];
  return {part.mesh.positions[t[0]], part.mesh.positions[t[1]], part.mesh.positions[t[2]]};
}

std::vector<BuildItem> TriangleSet::items() const {
  std::vector<BuildItem> items(size_);
  for (const Part& part : parts_) {
    parallel_for(part.mesh.triangles.size(), [&](size_t i) {
      BuildItem& item = items[part.first + i];
      item.id = part.first + uint32_t(i);
      if (!is_hittable(part.mesh, part.mesh.triangles[i])) return;
      for (const uint32_t vertex : part.mesh.triangles[i]) item.box.add(middle_position(part.mesh, vertex));
    });
  }
  std::erase_if(items, [](const BuildItem& item) { return item.box.empty(); });
  return items;
}

TriangleBlock TriangleSet::block(std::span<const uint32_t> triangles) const {
  TriangleBlock block;
  for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane) {
    const uint32_t triangle = triangles[std::min<size_t>(lane, triangles.size() - 1)];
    const Part& part = part_of(triangle);
    block.instance[lane] = part.instance;
    block.primitive[lane] = triangle - part.first;
  }
  return block;
}

template <typename PositionsOf>
void TriangleSet::load_from(const PositionsOf& positions_of, TriangleBlock& block) const {
  const auto instance_is_less = [](const Part& part, uint32_t instance) { return part.instance < instance; };
  for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane) {
    const Part& part =
        *std::lower_bound(parts_.begin(), parts_.end(), block.instance[lane], instance_is_less);
    const Triangle& indices = part.mesh.triangles[block.primitive[lane]];
    const std::span<const Vec3f> positions = positions_of(part.mesh);
    for (int vertex = 0; vertex < 3; ++vertex)
      for (int axis = 0; axis < 3; ++axis)
        block.vertex[vertex][axis][lane] = positions[indices[vertex]][axis];
  }
}

void TriangleSet::load(TriangleBlock& block) const {
  load_from([](const GeometryMesh& mesh) { return mesh.positions; }, block);
}

void TriangleSet::load(TriangleBlock& block, size_t moment) const {
  load_from([&](const GeometryMesh& mesh) { return mesh.moments[moment]; }, block);
}

bool is_hittable(const GeometryMesh& mesh, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  if (!mesh.moves()) return is_hittable(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
  bool has_area = false;
  for (const auto& p : mesh.moments) {
    if (!is_finite(p[a]) || !is_finite(p[b]) || !is_finite(p[c])) return false;
    has_area = has_area || is_hittable(p[a], p[b], p[c]);
  }
  return has_area;
}

std::vector<Triangle> without_unhittable(const GeometryMesh& mesh) {
  const auto is_out = [&](const Triangle& t) { return !is_hittable(mesh, t); };
  std::atomic<bool> any = false;
  constexpr size_t triangles_a_task = 1 << 14;
  parallel_for((mesh.triangles.size() + triangles_a_task - 1) / triangles_a_task, [&](size_t task) {
    const auto rest = mesh.triangles.subspan(task * triangles_a_task);
    if (std::ranges::any_of(rest.first(std::min(rest.size(), triangles_a_task)), is_out)) any = true;
  });
  if (!any) return {};
  std::vector<Triangle> triangles(mesh.triangles.begin(), mesh.triangles.end());
  for (Triangle& t : triangles)
    if (is_out(t)) t.fill(std::numeric_limits<uint32_t>::max());
  return triangles;
}

Bounds bounds_of(const TriangleBlock& block) {
  Bounds box;
  for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane)
    for (const auto& vertex : block.vertex) box.add({vertex[0][lane], vertex[1][lane], vertex[2][lane]});
  return box;
}

}  // namespace vernier
