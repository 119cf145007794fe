// SPDX-License-Identifier: Apache-2.0
#include "scene/subject.h"

#include <ImathMatrixAlgo.h>

#include <numeric>

#include "core/base/parallel.h"

namespace vernier {
namespace {

/// An instance so many times as large as the subject may be its setting.
constexpr float setting_ratio = 10;
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

/// The point found so far that lies farthest along a direction.
struct Farthest {
  Vec3f point{0, 0, 0};
  float along = -std::numeric_limits<float>::infinity();

  void add(const Farthest& other) {
    if (other.along > along) *this = other;
  }
};

/// Sums over triangles, weighted by area: of n n^T, whose largest eigenvector is the normal of something
/// flat, and of n.
struct NormalSums {
  Imath::M33d tensor{0, 0, 0, 0, 0, 0, 0, 0, 0};
  Vec3d normal{0, 0, 0};

  void add(const NormalSums& other) {
    tensor += other.tensor;
    normal += other.normal;
  }
};

Bounds bounds_of(const SceneGeometry& geometry, uint32_t instance) {
  return over_blocks(
      geometry.triangle_count(instance),
      [&](Bounds& bounds, uint32_t i) {
        for (const Vec3f& p : geometry.triangle(instance, i))
          if (is_finite(p)) bounds.add(p);
      },
      Bounds{});
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
    if (const Bounds bounds = bounds_of(geometry, i); !bounds.empty()) parts_.push_back({i, bounds});
  std::stable_sort(parts_.begin(), parts_.end(),
                   [](const Part& a, const Part& b) { return a.bounds.radius() < b.bounds.radius(); });
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
    if (!is_flat(part) && !is_inside_out(geometry, parts_[i].instance, rest.center())) break;
    if (rest.radius() > 0 && part.radius() >= setting_ratio * rest.radius()) kept = i;
  }
  left_out_ = parts_.size() - kept;
  parts_.resize(kept);
  if (kept > 0) bounds_ = up_to[kept - 1];
}

Bounds Subject::bounds_to_see() const {
  Bounds seen = bounds_;
  if (!seen.empty()) return seen;
  seen.add(Vec3f(-1));
  seen.add(Vec3f(1));
  return seen;
}

Vec3f Subject::farthest(const Vec3f& direction) const {
  Farthest best;
  // From the largest, which has the best chance; what cannot reach as far is not looked at.
  for (auto part = parts_.rbegin(); part != parts_.rend(); ++part) {
    const Vec3f corner(direction.x > 0 ? part->bounds.upper.x : part->bounds.lower.x,
                       direction.y > 0 ? part->bounds.upper.y : part->bounds.lower.y,
                       direction.z > 0 ? part->bounds.upper.z : part->bounds.lower.z);
    if (dot(corner, direction) <= best.along) continue;
    best.add(over_blocks(
        geometry_.triangle_count(part->instance),
        [&](Farthest& far, uint32_t i) {
          for (const Vec3f& p : geometry_.triangle(part->instance, i))
            if (is_finite(p)) far.add({p, dot(p, direction)});
        },
        Farthest{}));
  }
  return best.point;
}

std::optional<Vec3f> Subject::flat_normal(const Vec3f& viewer) const {
  NormalSums sums;
  for (const Part& part : parts_)
    sums.add(over_blocks(
        geometry_.triangle_count(part.instance),
        [&](NormalSums& sum, uint32_t i) {
          const auto [a, b, c] = geometry_.triangle(part.instance, i);
          const Vec3d n = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
          const double area = length(n);
          if (!(area > 0) || !std::isfinite(area)) return;
          sum.normal += n;
          sum.tensor += Imath::outerProduct(n, n) * (1 / area);
        },
        NormalSums{}));
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
