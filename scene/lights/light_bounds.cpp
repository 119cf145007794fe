// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/light_bounds.h"

#include "core/math/rounding.h"

namespace vernier {
namespace {

constexpr double half_turn = std::numbers::pi;

/// Directions about an axis, whose length does not matter, up to an angle from it.
struct Cone {
  Vec3d axis{0, 0, 1};
  double spread = half_turn;
};

/// Of a light without a direction, the whole sphere.
Cone cone_of(const LightBounds& bounds) {
  const Vec3d axis(bounds.axis);
  if (!(std::abs(length(axis) - 1) < 1e-3) || !(bounds.cos_spread > -1)) return {};
  return {axis, std::acos(std::min(double(bounds.cos_spread), 1.0))};
}

/// Through sine and cosine both, which keeps the digits of angles near 0 and pi.
double angle_between(const Vec3d& a, const Vec3d& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

Vec3d rotate_toward(const Vec3d& from, const Vec3d& to, double angle) {
  const Vec3d start = normalize(from), across = normalize(to - start * dot(start, to));
  return start * std::cos(angle) + across * std::sin(angle);
}

/// The smallest cone about both, but for axes that are opposite, or nearly so: between those no direction is
/// better than another, and the whole sphere is about as small.
Cone join(const Cone& a, const Cone& b) {
  if (a.spread >= half_turn || b.spread >= half_turn) return {};
  const double apart = angle_between(a.axis, b.axis);
  if (apart + b.spread <= a.spread) return a;
  if (apart + a.spread <= b.spread) return b;
  const double spread = (a.spread + apart + b.spread) / 2;
  if (spread >= half_turn || apart > half_turn - 1e-3) return {};
  // The axis is kept in float. What it is then decides how wide the cone has to be.
  const Vec3d axis(Vec3f(rotate_toward(a.axis, b.axis, spread - a.spread)));
  return {axis, std::max(angle_between(axis, a.axis) + a.spread, angle_between(axis, b.axis) + b.spread)};
}

/// Rounded so that the cone only grows.
float cosine_of_spread(double spread) {
  if (spread == 0) return 1;
  return std::max(next_float_down(float(std::cos(spread))), -1.f);
}

/// Whether the cone of `inner`, its axis turned about where `turned`, certainly lies within that of `outer`.
/// Told without the angles, each of which costs more than all of this; near the limit the answer is no.
bool is_surely_within(const LightBounds& inner, bool turned, const LightBounds& outer) {
  const double cos_inner = inner.cos_spread, cos_outer = outer.cos_spread;
  if (!(cos_inner >= cos_outer && cos_outer > -1 && cos_inner <= 1)) return false;
  const Vec3d a(inner.axis), b(outer.axis);
  const double square_a = length_squared(a), square_b = length_squared(b);
  constexpr double nearly_unit = 1e-4;
  if (!(std::abs(square_a - 1) < nearly_unit && std::abs(square_b - 1) < nearly_unit)) return false;
  if (turned ? inner.axis == -outer.axis : inner.axis == outer.axis) return true;
  const double room = cos_outer * cos_inner + std::sqrt((1 - square(cos_outer)) * (1 - square(cos_inner)));
  return (turned ? -dot(a, b) : dot(a, b)) > (room + 1e-9) * std::sqrt(square_a * square_b);
}

/// As cosine_of_spread() has it of the angle of a cosine.
float cosine_kept(float cosine) { return cosine == 1 ? 1 : std::max(next_float_down(cosine), -1.f); }

}  // namespace

LightBounds merge(const LightBounds& a, const LightBounds& b) {
  if (a.power == 0) return b;
  if (b.power == 0) return a;
  LightBounds both;
  both.box = a.box;
  both.box.add(b.box);
  both.power = a.power + b.power;
  both.two_sided = a.two_sided || b.two_sided;
  both.cos_emission = std::min(a.cos_emission, b.cos_emission);
  const bool turned = both.two_sided && dot(Vec3d(a.axis), Vec3d(b.axis)) < 0;
  if (is_surely_within(b, turned, a)) {
    both.axis = a.axis;
    both.cos_spread = cosine_kept(a.cos_spread);
    return both;
  }
  if (is_surely_within(a, turned, b)) {
    both.axis = turned ? -b.axis : b.axis;
    both.cos_spread = cosine_kept(b.cos_spread);
    return both;
  }
  const Cone cone_a = cone_of(a);
  Cone cone_b = cone_of(b);
  if (both.two_sided && dot(cone_a.axis, cone_b.axis) < 0) cone_b.axis = -cone_b.axis;
  const Cone cone = join(cone_a, cone_b);
  both.axis = Vec3f(cone.axis);
  both.cos_spread = cosine_of_spread(cone.spread);
  return both;
}

}  // namespace vernier
