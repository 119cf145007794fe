// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/math.h"

namespace vernier {

/// A triangle as a point sees it, for sampling it uniformly by solid angle.
class SphericalTriangle {
 public:
  /// Corners relative to the point; `normal` is cross(b - a, c - a). Seen edge-on, or from one of its
  /// corners, the triangle has no solid angle.
  SphericalTriangle(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& normal)
      : inverse_lengths_{inverse(a), inverse(b), inverse(c)},
        a_(a * inverse_lengths_.x),
        b_(b * inverse_lengths_.y),
        c_(c * inverse_lengths_.z),
        volume_(std::abs(dot(a, normal)) * (inverse_lengths_.x * inverse_lengths_.y * inverse_lengths_.z)),
        one_plus_ab_(1 + dot(a_, b_)),
        ac_plus_bc_(dot(a_, c_) + dot(b_, c_)),
        half_angle_(volume_ > least_volume ? std::atan2(volume_, one_plus_ab_ + ac_plus_bc_) : 0) {}

  /// Steradians, below 2 pi (Van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle"). The
  /// volume comes from the triangle's own normal, so that small angles do not cancel.
  float solid_angle() const { return 2 * half_angle_; }

  /// Barycentrics of b and c of the point of the triangle where a direction uniform within it goes. Only
  /// where there is a solid angle. After Arvo 1995, "Stratified Sampling of Spherical Triangles", in the form
  /// without inverse trigonometry of Peters 2021, "BRDF Importance Sampling for Polygonal Lights", section 4.
  Vec2f sample(const Vec2f& u) const {
    // The corner c moves toward a until the part of the angle between is u.x of it.
    const float angle = u.x * half_angle_;
    const float sine = std::sin(angle);
    const float to_a = volume_ * std::cos(angle) - ac_plus_bc_ * sine, to_c = one_plus_ab_ * sine;
    const Vec3f half_way = a_ * to_a + c_ * to_c;
    const float reflect = 2 * dot(a_, half_way) / length_squared(half_way);
    const float moved_a = reflect * to_a - 1, moved_c = reflect * to_c;
    const Vec3f moved = half_way * reflect - a_;
    // Then a point on the arc from b to there, uniform in the cosine of its angle; 1 - cosine comes from the
    // chord, which keeps its digits when the angle is small.
    const float height = length_squared(moved - b_) / 2;
    const float t = std::sqrt(u.y * (2 - u.y * height) / std::max(2 - height, 1e-6f));
    const float at_a = std::max(t * moved_a, 0.f) * inverse_lengths_.x;
    const float at_b = std::max(1 - u.y * height - t * (1 - height), 0.f) * inverse_lengths_.y;
    const float at_c = std::max(t * moved_c, 0.f) * inverse_lengths_.z;
    // The direction is the sum of the corners with these weights, and their shares are the barycentrics of
    // the point where it meets the plane.
    const float sum = at_a + at_b + at_c;
    return sum > 0 ? Vec2f(at_b / sum, at_c / sum) : Vec2f(1 / 3.f, 1 / 3.f);
  }

 private:
  /// Below this, which only rounding tells from an edge-on view, squares could underflow.
  static constexpr float least_volume = 1e-15f;

  static float inverse(const Vec3f& v) {
    const float squared = length_squared(v);
    return squared > 0 ? 1 / std::sqrt(squared) : 0;
  }

  Vec3f inverse_lengths_{0, 0, 0};              ///< of the corners' distances
  Vec3f a_{0, 0, 0}, b_{0, 0, 0}, c_{0, 0, 0};  ///< unit directions to the corners
  float volume_ = 0, one_plus_ab_ = 0, ac_plus_bc_ = 0;
  float half_angle_ = 0;
};

}  // namespace vernier
