// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/cross_check.h"

#include "scene/accel/instance.h"

namespace vernier::validation {
namespace {

constexpr size_t kept_examples = 5;

bool is_same(const std::optional<RawHit>& a, const std::optional<RawHit>& b) {
  if (!a || !b) return !a && !b;
  return a->instance == b->instance && a->primitive == b->primitive;
}

}  // namespace

std::optional<RawHit> CrossCheck::closest(const Ray& ray) const {
  check_closest(ray);
  return mine_->closest(ray);
}

bool CrossCheck::occluded(const Ray& ray) const {
  check_occluded(ray);
  return mine_->occluded(ray);
}

bool CrossCheck::occluded(const Ray& ray, std::vector<RawHit>& passed) const {
  check_occluded(ray);
  return mine_->occluded(ray, passed);
}

void CrossCheck::all_hits(const Ray& ray, std::vector<RawHit>& sorted) const {
  check_closest(ray);
  mine_->all_hits(ray, sorted);
}

void CrossCheck::check_closest(const Ray& ray) const {
  ++rays_;
  const auto a = a_->closest(ray), b = b_->closest(ray);
  if (!is_same(a, b)) judge({ray, false, a, b});
}

void CrossCheck::check_occluded(const Ray& ray) const {
  ++rays_;
  if (a_->occluded(ray) != b_->occluded(ray)) judge({ray, true, a_->closest(ray), b_->closest(ray)});
}

void CrossCheck::judge(const Difference& difference) const {
  double distortion = 1;
  const Geometry view = geometry_.view();
  const auto corners = [&](const std::optional<RawHit>& hit) -> std::optional<Corners> {
    if (!hit) return std::nullopt;
    // Accelerators may round the vertices of what moves each in its own way, and so what they meet.
    if (geometry_.moments(hit->instance) > 0) distortion = std::max(distortion, 2.0);
    const Transform& to_world = view.instances[hit->instance].to_world;
    if (!to_world.is_identity())
      if (const auto to_mesh = WorldToMesh::of(to_world))
        distortion = std::max(distortion, 2 * to_mesh->distortion(to_world));
    return geometry_.triangle(hit->instance, hit->primitive, difference.ray.time);
  };
  const auto a = corners(difference.mine), b = corners(difference.other);
  const Excuse why = excuse(difference.ray, a, b, distortion);
  const std::lock_guard lock(mutex_);
  switch (why) {
    case Excuse::boundary:
      ++found_.at_boundary;
      found_.leaks += !a || !b;
      break;
    case Excuse::end:
      ++found_.at_end;
      break;
    case Excuse::tie:
      ++found_.tied;
      break;
    case Excuse::none:
      ++found_.real;
      if (found_.examples.size() < kept_examples) found_.examples.push_back(difference);
  }
}

CrossCheckResult CrossCheck::result() const {
  const std::lock_guard lock(mutex_);
  CrossCheckResult result = found_;
  result.rays = rays_;
  return result;
}

}  // namespace vernier::validation
