// SPDX-License-Identifier: Apache-2.0
#include "scene/turntable.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vernier {
namespace {

double cross(const Vec2d& o, const Vec2d& a, const Vec2d& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// The part of a planar convex hull that faces +x: all that the farthest points in directions with x >= 0
/// can be (A. M. Andrew, 1979).
std::vector<Vec2d> right_hull(std::vector<Vec2d> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2d& a, const Vec2d& b) { return a.y != b.y ? a.y < b.y : a.x > b.x; });
  std::vector<Vec2d> hull;
  for (const Vec2d& p : points) {
    while (hull.size() > 1 && cross(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
    hull.push_back(p);
  }
  return hull;
}

}  // namespace

TurnedSubject::TurnedSubject(const Subject& subject) : center_(subject.bounds_to_see().center()) {
  std::vector<Vec2d> points;
  const auto add = [&](const Vec3f& p) {
    points.emplace_back(std::hypot(double(p.x) - center_.x, double(p.z) - center_.z), p.y);
    constexpr size_t many = 1 << 16;
    if (points.size() > many) points = right_hull(std::move(points));
  };
  const Bounds seen = subject.bounds_to_see();
  if (subject.empty()) {
    add(seen.lower);
    add(seen.upper);
  }
  subject.for_each_corner(add);
  profile_ = right_hull(std::move(points));
}

Vec3f TurnedSubject::farthest(const Vec3f& direction) const {
  const double across = std::hypot(double(direction.x), double(direction.z));
  const auto along = [&](const Vec2d& p) { return p.x * across + p.y * direction.y; };
  const Vec2d& best = *std::max_element(profile_.begin(), profile_.end(),
                                        [&](const Vec2d& a, const Vec2d& b) { return along(a) < along(b); });
  const double scale = across > 0 ? best.x / across : 0;
  return {float(center_.x + scale * direction.x), float(best.y), float(center_.z + scale * direction.z)};
}

CameraDescription fitted_turntable_camera(const Subject& subject, float aspect, const FittedView& view) {
  const TurnedSubject turned(subject);
  return fit_camera(
      aimed_camera(subject, view), [&](const Vec3f& direction) { return turned.farthest(direction); }, aspect,
      view.margin);
}

CameraDescription carried_around(CameraDescription camera, const Vec3f& center, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](const Vec3f& v) {
    return Vec3f(float(c * v.x + s * v.z), v.y, float(c * v.z - s * v.x));
  };
  const auto carry_frame = [&](Transform& place) {
    place = {turn(place.x), turn(place.y), turn(place.z), center + turn(place.origin - center)};
  };
  carry_frame(camera.to_world);
  for (Transform& moment : camera.moments) carry_frame(moment);
  return camera;
}

CameraDescription carried_on(const CameraDescription& camera, const Vec3f& center, double from, double to) {
  // Chords of two degrees are nowhere farther from the circle than 1/6500 of its radius.
  constexpr double longest = 2 * std::numbers::pi / 180;
  size_t segments = 1;
  while (segments < most_moments - 1 && std::abs(to - from) > longest * double(segments)) segments *= 2;
  segments = std::max(segments, std::max<size_t>(camera.moments.size(), 2) - 1);
  CameraDescription carried = carried_around(camera, center, (from + to) / 2);
  carried.moments.clear();
  for (size_t i = 0; i <= segments; ++i) {
    CameraDescription still = camera;
    still.moments.clear();
    // One that moves by itself is taken from the nearest of its own moments.
    if (!camera.moments.empty()) still.to_world = camera.moments[i * (camera.moments.size() - 1) / segments];
    const double angle = from + (to - from) * double(i) / double(segments);
    carried.moments.push_back(carried_around(still, center, angle).to_world);
  }
  return carried;
}

}  // namespace vernier
