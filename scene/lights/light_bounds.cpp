#include "scene/lights/light_bounds.h"

namespace vernier {
namespace {

Vec3f rotate_toward(const Vec3f& from, const Vec3f& to, float angle) {
  const Vec3f across = to - from * dot(from, to);
  const float size = length(across);
  return size > 0 ? from * std::cos(angle) + across * (std::sin(angle) / size) : from;
}

}  // namespace

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
