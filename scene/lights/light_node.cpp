// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/light_node.h"

#include "core/math/rounding.h"
#include "scene/lights/sine.h"

namespace vernier {
namespace {

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

/// What rounding, also that of directions to 16 bits, may take off a cosine in importance() where the angle
/// is near 0 or pi; also the least cosine that counts, so that light which grazes is found.
constexpr float slack = 0x1p-8f;

/// Keeps the sum of eight slots finite.
constexpr float least_distance2 = 1e-30f;

/// Of what may be lit, however faint a light is beside others.
constexpr float least_importance = std::numeric_limits<float>::min();

constexpr float axis_parts = 0x7fff, half_sine_parts = 0xffff, emission_parts = 127;

/// The nearest of the floats whose lower half is zero; of what is positive never zero or infinite.
uint16_t upper_half(float positive) {
  const auto bits = std::bit_cast<uint32_t>(std::max(positive, std::numeric_limits<float>::min()));
  return uint16_t(std::min((bits + 0x7fffu + (bits >> 16 & 1)) >> 16, 0x7f7fu));
}

template <typename Narrow>
Float8 floats_of(const Narrow& integers) {
  return __builtin_convertvector(__builtin_convertvector(integers, Mask8), Float8);
}

}  // namespace

void LightNode::set(int slot, const LightBounds& bounds) {
  const Vec3f center = bounds.box.center();
  center_x_[slot] = center.x;
  center_y_[slot] = center.y;
  center_z_[slot] = center.z;
  radius2_[slot] = square(bounding_radius(bounds.box, center)) * (1 + 1e-6f);
  const bool has_axis = std::abs(length_squared(bounds.axis) - 1) < 1e-3f;
  const Vec3f axis = has_axis ? bounds.axis * axis_parts : Vec3f(0, 0, axis_parts);
  const auto part = [](float x) { return int16_t(std::clamp(std::round(x), -axis_parts, axis_parts)); };
  axis_x_[slot] = part(axis.x);
  axis_y_[slot] = part(axis.y);
  axis_z_[slot] = part(axis.z);
  const float half_sine = has_axis ? safe_sqrt((1 - bounds.cos_spread) / 2) : 1;
  half_sine_[slot] = uint16_t(std::min(std::ceil(half_sine * half_sine_parts), half_sine_parts));
  cos_emission_[slot] = int8_t(std::floor(std::clamp(bounds.cos_emission, -1.f, 1.f) * emission_parts));
  power_[slot] = upper_half(bounds.power);
  if (bounds.two_sided) two_sided_ |= uint8_t(1 << slot);
}

void LightNode::set_light(int slot, uint32_t light) {
  child_[size_t(slot)] = light;
  leaf_ |= uint8_t(1 << slot);
}

void LightNode::set_parent(uint32_t up, int slot) {
  to_parent_ = up;
  slot_in_parent_ = uint8_t(slot);
}

Float8 LightNode::importance(const LightReceiver& receiver) const {
  const Float8 x = center_x_ - receiver.position.x, y = center_y_ - receiver.position.y,
               z = center_z_ - receiver.position.z;
  Float8 distance2 = x * x + y * y + z * z;
  const Mask8 outside = distance2 > radius2_;
  keep_greater(Float8{} + least_distance2, distance2);
  Float8 inside2 = radius2_;
  keep_greater(Float8{} + least_distance2, inside2);
  const Float8 inverse2 = 1 / (outside ? distance2 : inside2), inverse = square_root(inverse2);

  // Angle that the sphere fills seen from the receiver. From inside it, what follows is not used.
  Float8 sin_sphere = radius2_ * inverse2;
  keep_smaller(Float8{} + 1, sin_sphere);
  const Float8 cos_sphere = square_root(1 - sin_sphere);
  sin_sphere = square_root(sin_sphere);

  const Float8 half_sine = floats_of(half_sine_) * (1 / half_sine_parts);
  const Float8 half_sine2 = half_sine * half_sine, cos_spread = 1 - 2 * half_sine2,
               sin_spread = 2 * half_sine * square_root(1 - half_sine2);
  Float8 cos_axis =
      -(floats_of(axis_x_) * x + floats_of(axis_y_) * y + floats_of(axis_z_) * z) * (inverse / axis_parts);
  const Mask8 two_sided = ((Mask8{} + two_sided_) & Mask8{1, 2, 4, 8, 16, 32, 64, 128}) != 0;
  cos_axis = (two_sided & (cos_axis < 0)) ? -cos_axis : cos_axis;
  const Float8 cos_nearest = cos_difference(sine_of(cos_axis), cos_axis, sin_spread, cos_spread);
  Float8 cos_emitted = cos_difference(sine_of(cos_nearest), cos_nearest, sin_sphere, cos_sphere);
  Mask8 lit = cos_emitted > floats_of(cos_emission_) * (1 / emission_parts) - slack;
  keep_greater(Float8{} + slack, cos_emitted);

  if (receiver.normal != Vec3f(0, 0, 0)) {
    const Float8 cos_center =
        (receiver.normal.x * x + receiver.normal.y * y + receiver.normal.z * z) * inverse;
    Float8 cos_incident = cos_difference(sine_of(cos_center), cos_center, sin_sphere, cos_sphere);
    lit &= cos_incident > -slack;
    keep_greater(Float8{} + slack, cos_incident);
    cos_emitted *= cos_incident;
  }

  const Float8 power = std::bit_cast<Float8>(__builtin_convertvector(power_, Mask8) << 16);
  // Inside the sphere distance and direction mean little; its radius keeps one near light from taking all. A
  // place without extent does not light itself.
  Float8 value = power * inverse2 * (outside ? cos_emitted : Float8{} + 1);
  keep_greater(Float8{} + least_importance, value);
  const Mask8 counts = (outside ? lit : radius2_ > 0) & (power > 0);
  return counts ? value : Float8{};
}

}  // namespace vernier
