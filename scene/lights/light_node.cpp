// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/light_node.h"

#include "core/math/rounding.h"

namespace vernier {
namespace {

Float8 sine(const Float8& cosine) {
  Float8 square = 1 - cosine * cosine;
  keep_greater(Float8{}, square);
  return square_root(square);
}

/// cos(max(0, a - b)) of two angles in [0, pi] given by cosine and sine.
Float8 cos_difference(const Float8& sin_a, const Float8& cos_a, const Float8& sin_b, const Float8& cos_b) {
  return cos_a > cos_b ? Float8{} + 1 : cos_a * cos_b + sin_a * sin_b;
}

/// Radius about the rounded center within which the whole box lies, rounding included.
float bounding_radius(const Bounds& box, const Vec3f& center) {
  const Vec3d below = Vec3d(center) - Vec3d(box.lower), above = Vec3d(box.upper) - Vec3d(center);
  const double radius =
      length(Vec3d(std::max(below.x, above.x), std::max(below.y, above.y), std::max(below.z, above.z)));
  return radius > 0 ? next_float_up(float(radius)) : 0;
}

/// What rounding may take off a cosine in importance() where the angle is near 0 or pi; also the least cosine
/// that counts, so that light which grazes is found.
constexpr float slack = 0x1p-8f;

/// Keeps the sum of eight slots finite.
constexpr float least_distance2 = 1e-30f;

/// Of what may be lit, however faint a light is beside others.
constexpr float least_importance = std::numeric_limits<float>::min();

}  // namespace

void LightNode::set(int slot, const LightBounds& bounds) {
  const Vec3f center = bounds.box.center();
  center_x_[slot] = center.x;
  center_y_[slot] = center.y;
  center_z_[slot] = center.z;
  const float radius2 = square(bounding_radius(bounds.box, center)) * (1 + 1e-6f);
  radius2_[slot] = radius2;
  const bool has_axis = std::abs(length_squared(bounds.axis) - 1) < 1e-3f;
  const float cos_spread = has_axis ? bounds.cos_spread : -1;
  axis_x_[slot] = has_axis ? bounds.axis.x : 0;
  axis_y_[slot] = has_axis ? bounds.axis.y : 0;
  axis_z_[slot] = has_axis ? bounds.axis.z : 1;
  cos_spread_[slot] = cos_spread;
  sin_spread_[slot] = safe_sqrt(1 - square(cos_spread));
  cos_emission_[slot] = bounds.cos_emission - slack;
  power_[slot] = bounds.power;
  // Inside the sphere distance and direction mean little; its radius keeps one near light from taking all. A
  // place without extent does not light itself.
  if (radius2 > 0)
    inside_[slot] = std::max(bounds.power / std::max(radius2, least_distance2), least_importance);
  two_sided_[slot] = bounds.two_sided ? -1 : 0;
}

Float8 LightNode::importance(const LightReceiver& receiver) const {
  const Float8 x = center_x_ - receiver.position.x, y = center_y_ - receiver.position.y,
               z = center_z_ - receiver.position.z;
  Float8 distance2 = x * x + y * y + z * z;
  const Mask8 outside = distance2 > radius2_;
  keep_greater(Float8{} + least_distance2, distance2);
  const Float8 inverse = 1 / square_root(distance2);

  // Angle that the sphere fills seen from the receiver. From inside it, what follows is not used.
  Float8 sin_sphere = radius2_ / distance2;
  keep_smaller(Float8{} + 1, sin_sphere);
  const Float8 cos_sphere = square_root(1 - sin_sphere);
  sin_sphere = square_root(sin_sphere);

  Float8 cos_axis = -(axis_x_ * x + axis_y_ * y + axis_z_ * z) * inverse;
  cos_axis = (two_sided_ & (cos_axis < 0)) ? -cos_axis : cos_axis;
  const Float8 cos_nearest = cos_difference(sine(cos_axis), cos_axis, sin_spread_, cos_spread_);
  Float8 cos_emitted = cos_difference(sine(cos_nearest), cos_nearest, sin_sphere, cos_sphere);
  Mask8 lit = cos_emitted > cos_emission_;
  keep_greater(Float8{} + slack, cos_emitted);
  Float8 value = power_ * cos_emitted / distance2;

  if (receiver.normal != Vec3f(0, 0, 0)) {
    const Float8 cos_center =
        (receiver.normal.x * x + receiver.normal.y * y + receiver.normal.z * z) * inverse;
    Float8 cos_incident = cos_difference(sine(cos_center), cos_center, sin_sphere, cos_sphere);
    lit &= cos_incident > -slack;
    keep_greater(Float8{} + slack, cos_incident);
    value *= cos_incident;
  }

  keep_greater(Float8{} + least_importance, value);
  return outside ? (lit ? value : Float8{}) : inside_;
}

}  // namespace vernier
