#include "scene/lights/light_bounds.h"

namespace vernier {
namespace {

float sine(float cosine) { return safe_sqrt(1 - cosine * cosine); }

/// cos(max(0, a - b)) of two angles in [0, pi] given by cosine and sine.
float cos_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
  return cos_a > cos_b ? 1 : cos_a * cos_b + sin_a * sin_b;
}

Vec3f rotate_toward(const Vec3f& from, const Vec3f& to, float angle) {
  const Vec3f across = to - from * dot(from, to);
  const float size = length(across);
  return size > 0 ? from * std::cos(angle) + across * (std::sin(angle) / size) : from;
}

}  // namespace

float LightBounds::importance(const LightReceiver& receiver) const {
  const Vec3f to_light = box.center() - receiver.position;
  const float radius2 = length_squared(box.upper - box.lower) / 4;
  const float true_distance2 = length_squared(to_light);
  // Inside the box distance means little; half its diagonal keeps one near light from taking all.
  const float distance2 = std::max({true_distance2, radius2, std::numeric_limits<float>::min()});
  if (true_distance2 <= radius2) return power / distance2;
  const Vec3f wi = to_light * (1 / std::sqrt(true_distance2));

  // Angle that the box's sphere fills seen from the receiver.
  const float sin2_b = radius2 / true_distance2;
  const float sin_b = std::sqrt(sin2_b), cos_b = safe_sqrt(1 - sin2_b);

  float cos_w = -dot(axis, wi);
  if (two_sided) cos_w = std::abs(cos_w);
  const float sin_w = sine(cos_w);
  const float cos_x = cos_difference(sin_w, cos_w, sine(cos_spread), cos_spread);
  const float cos_p = cos_difference(sine(cos_x), cos_x, sin_b, cos_b);
  if (cos_p <= cos_emission) return 0;

  float cos_i = 1;
  if (length_squared(receiver.normal) > 0) {
    cos_i = dot(receiver.normal, wi);
    cos_i = cos_difference(sine(cos_i), cos_i, sin_b, cos_b);
    if (cos_i <= 0) return 0;
  }
  return power * cos_p * cos_i / distance2;
}

LightBounds merge(const LightBounds& a, const LightBounds& b) {
  if (a.power == 0) return b;
  if (b.power == 0) return a;
  LightBounds both = a;
  both.box.add(b.box.lower);
  both.box.add(b.box.upper);
  both.power = a.power + b.power;
  both.two_sided = a.two_sided || b.two_sided;
  both.cos_emission = std::min(a.cos_emission, b.cos_emission);

  // Smallest cone about both spreads.
  const auto angle = [](float cosine) { return std::acos(std::clamp(cosine, -1.f, 1.f)); };
  const float spread_a = angle(a.cos_spread), spread_b = angle(b.cos_spread);
  const Vec3f axis_b = both.two_sided && dot(a.axis, b.axis) < 0 ? -b.axis : b.axis;
  const float apart = angle(dot(a.axis, axis_b));
  if (std::min(apart + spread_b, pi) <= spread_a) return both;
  if (std::min(apart + spread_a, pi) <= spread_b) {
    both.axis = axis_b;
    both.cos_spread = b.cos_spread;
    return both;
  }
  const float spread = (spread_a + apart + spread_b) / 2;
  if (spread >= pi) {
    both.cos_spread = -1;
    return both;
  }
  both.axis = normalize(rotate_toward(a.axis, axis_b, spread - spread_a));
  both.cos_spread = std::cos(spread);
  return both;
}

}  // namespace vernier
