// SPDX-License-Identifier: Apache-2.0
#include "scene/subject.h"

#include <ImathMatrixAlgo.h>

#include <map>
#include <numeric>

#include "core/base/parallel.h"

namespace vernier {
namespace {

/// An instance so many times as large as the subject may be its setting.
constexpr float setting_ratio = 10;
/// Radius of what is less than a pixel in a picture of all, and of what is next to nothing in it, over that
/// of all.
constexpr float invisible_ratio = 1e-3f, lost_ratio = 0.05f;
/// Least over middle extent of what counts as flat. A board that stands upright may be thicker: its face is
/// what it is for, while a thing that lies is seen well from above the ground, but for a sheet.
constexpr float flat_enough = 0.02f, flat_enough_upright = 0.15f;

bool is_flat(const Bounds& bounds) {
  Vec3f size = bounds.upper - bounds.lower;
  std::sort(&size.x, &size.x + 3);
  return size.x <= flat_enough * size.y;
}

/// Triangles looked at by one task.
constexpr size_t block_size = 1 << 14;

template <typename Value, typename Reduce>
Value over_blocks(size_t count, const Reduce& reduce, const Value& start) {
  std::vector<Value> values((count + block_size - 1) / block_size, start);
  parallel_for(values.size(), [&](size_t block) {
    for (size_t i = block * block_size; i < std::min(count, (block + 1) * block_size); ++i)
      reduce(values[block], uint32_t(i));
  });
  return std::accumulate(values.begin(), values.end(), start, [](Value a, const Value& b) {
    a.add(b);
    return a;
  });
}

/// Of the triangles that `corners_of` gives by their number.
template <typename CornersOf>
NormalSums sum_normals(size_t count, const CornersOf& corners_of) {
  return over_blocks(
      count,
      [&](NormalSums& sum, uint32_t i) {
        const auto [a, b, c] = corners_of(i);
        const Vec3d n = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
        const double area = length(n);
        if (!(area > 0) || !std::isfinite(area)) return;
        sum.normal += n;
        sum.tensor += Imath::outerProduct(n, n) * (1 / area);
      },
      NormalSums{});
}

NormalSums sum_in_world(const SceneGeometry& geometry, uint32_t instance) {
  return sum_normals(geometry.triangle_count(instance),
                     [&](uint32_t i) { return geometry.triangle(instance, i); });
}

NormalSums sum_in_mesh(const SceneGeometry& geometry, uint32_t instance) {
  return sum_normals(geometry.triangle_count(instance),
                     [&](uint32_t i) { return geometry.mesh_triangle(instance, i); });
}

/// How much larger a map makes things that it turns and mirrors, but does not distort; 0: it does distort.
double scale_of_similarity(const Transform& map) {
  const Vec3d x(map.x), y(map.y), z(map.z);
  const double square_scale = length_squared(x), tolerance = 1e-5 * square_scale;
  const auto is_small = [&](double value) { return std::abs(value) <= tolerance; };
  const bool keeps_shape = is_small(length_squared(y) - square_scale) &&
                           is_small(length_squared(z) - square_scale) && is_small(dot(x, y)) &&
                           is_small(dot(y, z)) && is_small(dot(z, x));
  return keeps_shape ? std::sqrt(square_scale) : 0;
}

/// Sums of a mesh that a similarity of linear part M and scale s places: normals of triangles become s M n
/// (a mirrored instance has its winding turned), so the tensor becomes M T M^T.
NormalSums placed(const NormalSums& mesh, const Transform& map, double scale) {
  // Imath multiplies rows, so its matrix is the transposed one.
  const Imath::M33d transposed(map.x.x, map.x.y, map.x.z, map.y.x, map.y.y, map.y.z, map.z.x, map.z.y,
                               map.z.z);
  NormalSums sums;
  sums.tensor = transposed.transposed() * mesh.tensor * transposed;
  sums.normal = (mesh.normal * transposed) * scale;
  return sums;
}

/// Whether most of a surface faces a point that it lies around.
bool is_inside_out(const SceneGeometry& geometry, uint32_t instance, const Vec3f& center) {
  struct Volume {
    double six_times = 0;
    void add(const Volume& other) { six_times += other.six_times; }
  };
  const Volume volume = over_blocks(
      geometry.triangle_count(instance),
      [&](Volume& sum, uint32_t i) {
        const auto [a, b, c] = geometry.triangle(instance, i);
        const Vec3d to_a(a - center), to_b(b - center), to_c(c - center);
        if (is_finite(a) && is_finite(b) && is_finite(c)) sum.six_times += dot(to_a, cross(to_b, to_c));
      },
      Volume{});
  return volume.six_times < 0;
}

}  // namespace

Subject::Subject(const SceneGeometry& geometry) : geometry_(geometry) {
  for (uint32_t i = 0; i < geometry.instance_count(); ++i)
    if (const Bounds& bounds = geometry.middle_bounds(i); bounds.radius() > 0) parts_.push_back({i, bounds});
  std::stable_sort(parts_.begin(), parts_.end(),
                   [](const Part& a, const Part& b) { return a.bounds.radius() < b.bounds.radius(); });
  leave_out_setting();
  leave_out_strays();
  for (const Part& part : parts_) bounds_.add(part.bounds);
}

void Subject::leave_out_setting() {
  std::vector<Bounds> up_to(parts_.size());
  for (size_t i = 0; i < parts_.size(); ++i) {
    if (i > 0) up_to[i] = up_to[i - 1];
    up_to[i].add(parts_[i].bounds);
  }
  // The subject ends where all that is larger is setting to it. What is not ten times as large as the
  // smallest is none to anything.
  size_t kept = parts_.size();
  for (size_t i = parts_.size(); i-- > 1;) {
    const Bounds &part = parts_[i].bounds, &rest = up_to[i - 1];
    if (part.radius() < setting_ratio * parts_[0].bounds.radius()) break;
    if (!is_flat(part) && !is_inside_out(geometry_, parts_[i].instance, rest.center())) break;
    if (rest.radius() > 0 && part.radius() >= setting_ratio * rest.radius()) kept = i;
  }
  left_out_ = parts_.size() - kept;
  parts_.resize(kept);
}

void Subject::leave_out_strays() {
  Bounds all, large;
  for (const Part& part : parts_) all.add(part.bounds);
  const auto is_small = [&](const Part& part) {
    return part.bounds.radius() < invisible_ratio * all.radius();
  };
  for (const Part& part : parts_)
    if (!is_small(part)) large.add(part.bounds);
  if (large.empty() || large.radius() >= lost_ratio * all.radius()) return;
  // Small parts of what is large, or near it, belong to it.
  const size_t before = parts_.size();
  std::erase_if(parts_, [&](const Part& part) {
    return is_small(part) && length(part.bounds.center() - large.center()) > 2 * large.radius();
  });
  strays_ = before - parts_.size();
}

Bounds Subject::bounds_to_see() const {
  Bounds seen = bounds_;
  if (!seen.empty()) return seen;
  seen.add(Vec3f(-1));
  seen.add(Vec3f(1));
  return seen;
}

Vec3f Subject::farthest(const Vec3f& direction) const {
  FarthestCorner best;
  // From the largest, which has the best chance; what cannot reach as far is not looked at.
  for (auto part = parts_.rbegin(); part != parts_.rend(); ++part) {
    const Vec3f corner(direction.x > 0 ? part->bounds.upper.x : part->bounds.lower.x,
                       direction.y > 0 ? part->bounds.upper.y : part->bounds.lower.y,
                       direction.z > 0 ? part->bounds.upper.z : part->bounds.lower.z);
    if (dot(corner, direction) <= best.along) continue;
    const FarthestCorner found = geometry_.farthest_corner(part->instance, direction);
    if (found.along > best.along) best = found;
  }
  return best.point;
}

NormalSums Subject::normal_sums() const {
  // Those that share a mesh need one look at its triangles.
  std::map<uint32_t, std::pair<uint32_t, size_t>>
      shared;  // by mesh: one of its instances, how many there are
  for (const Part& part : parts_)
    ++shared.try_emplace(geometry_.mesh_number(part.instance), part.instance, 0).first->second.second;
  std::erase_if(shared, [](const auto& use) { return use.second.second == 1; });
  std::map<uint32_t, NormalSums> of_meshes;
  for (const auto& [mesh, use] : shared) of_meshes.emplace(mesh, sum_in_mesh(geometry_, use.first));

  NormalSums all;
  std::vector<NormalSums> batch;
  constexpr size_t batch_size = 1024;
  for (size_t first = 0; first < parts_.size(); first += batch_size) {
    batch.resize(std::min(batch_size, parts_.size() - first));
    parallel_for(batch.size(), [&](size_t i) {
      const uint32_t instance = parts_[first + i].instance;
      const auto mesh = of_meshes.find(geometry_.mesh_number(instance));
      const double scale = mesh == of_meshes.end() ? 0 : scale_of_similarity(geometry_.to_world(instance));
      batch[i] = scale > 0 ? placed(mesh->second, geometry_.to_world(instance), scale)
                           : sum_in_world(geometry_, instance);
    });
    for (const NormalSums& sums : batch) all.add(sums);
  }
  return all;
}

std::optional<Vec3f> Subject::flat_normal(const Vec3f& viewer) const {
  const NormalSums sums = normal_sums();
  if (!(sums.tensor[0][0] + sums.tensor[1][1] + sums.tensor[2][2] > 0)) return std::nullopt;
  Imath::M33d axes, tensor = sums.tensor;
  Vec3d areas;
  Imath::jacobiEigenSolver(tensor, areas, axes);
  std::array<std::pair<double, double>, 3> sizes;  // area that faces along the axis, extent along it
  for (int i = 0; i < 3; ++i) {
    const Vec3f axis{float(axes[0][i]), float(axes[1][i]), float(axes[2][i])};
    sizes[size_t(i)] = {areas[i], dot(farthest(axis), axis) + dot(farthest(-axis), -axis)};
  }
  const size_t facing = size_t(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  const double others = std::min(sizes[(facing + 1) % 3].second, sizes[(facing + 2) % 3].second);
  const Vec3d normal(axes[0][int(facing)], axes[1][int(facing)], axes[2][int(facing)]);
  const bool upright = std::abs(normal.y) < 0.5;
  if (!(sizes[facing].second <= (upright ? flat_enough_upright : flat_enough) * others)) return std::nullopt;
  const double front = dot(sums.normal, normal);
  const bool one_sided = std::abs(front) > 0.01 * areas[int(facing)];
  const bool turn = one_sided ? front < 0 : dot(Vec3d(viewer), normal) < 0;
  return Vec3f(turn ? -normal : normal);
}

}  // namespace vernier
