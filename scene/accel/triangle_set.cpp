// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/triangle_set.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "core/base/parallel.h"
#include "scene/accel/triangle.h"
#include "vernier/error.h"

namespace vernier {

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
    tbb::parallel_for(
        tbb::blocked_range<uint32_t>(0, static_cast<uint32_t>(part.mesh.triangles.size()), 1 << 14),
        [&](const tbb::blocked_range<uint32_t>& range) {
          for (uint32_t i = range.begin(); i < range.end(); ++i) {
            const auto& [a, b, c] = part.mesh.triangles[i];
            const auto& p = part.mesh.positions;
            BuildItem& item = items[part.first + i];
            item.id = part.first + i;
            if (!is_hittable(p[a], p[b], p[c])) continue;
            for (const uint32_t vertex : {a, b, c}) item.box.add(p[vertex]);
          }
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
  reload(block);
  return block;
}

void TriangleSet::reload(TriangleBlock& block) const {
  const auto instance_is_less = [](const Part& part, uint32_t instance) { return part.instance < instance; };
  for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane) {
    const Part& part =
        *std::lower_bound(parts_.begin(), parts_.end(), block.instance[lane], instance_is_less);
    const Triangle& indices = part.mesh.triangles[block.primitive[lane]];
    for (int vertex = 0; vertex < 3; ++vertex)
      for (int axis = 0; axis < 3; ++axis)
        block.vertex[vertex][axis][lane] = part.mesh.positions[indices[vertex]][axis];
  }
}

std::vector<Triangle> without_unhittable(const GeometryMesh& mesh) {
  const auto& p = mesh.positions;
  const auto is_out = [&](const Triangle& t) { return !is_hittable(p[t[0]], p[t[1]], p[t[2]]); };
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
