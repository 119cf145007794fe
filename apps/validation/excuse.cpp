// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/excuse.h"

#include <algorithm>

namespace vernier::validation {
namespace {

/// A triangle that a ray is said to meet, and how far the meeting point may be elsewhere when the triangle's
/// vertices are known to four units in the last place only: the more the ray grazes it, the farther.
class Meeting {
 public:
  Meeting(const Ray& ray, const Corners& corners, double distortion)
      : hit_(intersect_exactly(ray, corners)),
        passes_edge_(distance_to_boundary(ray, corners) <= 4 * distortion * coordinate_ulp(ray, corners)) {
    const Vec3d a(corners[0]), b(corners[1]), c(corners[2]), normal = cross(b - a, c - a);
    const double double_area = length(normal), speed = length(Vec3d(ray.direction));
    const double cosine = std::abs(dot(Vec3d(ray.direction), normal)) / (double_area * speed);
    const double slack = 4 * distortion * coordinate_ulp(ray, corners) / cosine;
    t_bound_ = std::max(distortion * hit_.t_bound, slack / speed);
    // Distances in the plane from the point to the edges, by its barycentric weights.
    const double to_edge[] = {(1 - hit_.u - hit_.v) * double_area / length(c - b),
                              hit_.u * double_area / length(c - a), hit_.v * double_area / length(b - a)};
    for (const double distance : to_edge) passes_edge_ = passes_edge_ || std::abs(distance) <= slack;
  }

  /// Whether either answer is right.
  bool is_at_boundary() const { return passes_edge_ || hit_.kind == ExactHit::Kind::coplanar; }
  bool is_at(double t) const { return std::abs(hit_.t - t) <= t_bound_; }
  bool is_at(const Meeting& other) const {
    return std::abs(hit_.t - other.hit_.t) <= t_bound_ + other.t_bound_;
  }

 private:
  ExactHit hit_;
  bool passes_edge_;
  double t_bound_ = 0;
};

}  // namespace

Excuse excuse(const Ray& ray, const std::optional<Corners>& a, const std::optional<Corners>& b,
              double distortion) {
  std::optional<Meeting> at_a, at_b;
  if (a) at_a.emplace(ray, *a, distortion);
  if (b) at_b.emplace(ray, *b, distortion);
  for (const auto* at : {&at_a, &at_b})
    if (*at && (*at)->is_at_boundary()) return Excuse::boundary;
  for (const auto* at : {&at_a, &at_b})
    if (*at && ((*at)->is_at(ray.t_min) || (*at)->is_at(ray.t_max))) return Excuse::end;
  return at_a && at_b && at_a->is_at(*at_b) ? Excuse::tie : Excuse::none;
}

}  // namespace vernier::validation
