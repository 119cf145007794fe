// SPDX-License-Identifier: Apache-2.0
#include "scene/closed_surface.h"

#include <array>

namespace vernier {
namespace {

constexpr double largest_leak = 1e-3;  // of the area

/// Fields flow (s . x)^n with n = 0, 1, 2, 3: without divergence when flow and s are perpendicular. The
/// directions are those of no symmetry that a model is likely to have.
struct Field {
  Vec3d flow, along;
};

Field field(size_t i) {
  const double a = 0.7 + 2.399963 * double(i), z = 0.87 - 0.249 * double(i);
  const double r = std::sqrt(1 - z * z);
  const Vec3d along(r * std::cos(a), r * std::sin(a), z);
  const Vec3d other(std::cos(1.3 * a + 0.4), 0.61, std::sin(1.3 * a + 0.4));
  return {along.cross(other).normalized(), along};
}

}  // namespace

ClosedSurfaceTest::ClosedSurfaceTest(const Vec3f& lower, const Vec3f& upper)
    : center_((Vec3d(lower) + Vec3d(upper)) * 0.5) {
  const Vec3d half = (Vec3d(upper) - Vec3d(lower)) * 0.5;
  const double largest = std::max({half.x, half.y, half.z, 1e-300});
  // Flat bodies are stretched, for a map that is linear leaves the closed ones closed.
  for (int axis = 0; axis < 3; ++axis) scale_[axis] = 1 / std::max(half[axis], 1e-6 * largest);
}

void ClosedSurfaceTest::add(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3d p = (Vec3d(a) - center_) * scale_, q = (Vec3d(b) - center_) * scale_,
              r = (Vec3d(c) - center_) * scale_;
  const Vec3d area = (q - p).cross(r - p) * 0.5;
  const double size = area.length();
  if (!(size > 0) || !std::isfinite(size)) return;
  area_ += size;
  volume_ += area.dot(p) / 3;
  for (size_t i = 0; i < fields; ++i) {
    const auto [flow, along] = field(i);
    const double through = area.dot(flow), x = along.dot(p), y = along.dot(q), z = along.dot(r);
    // Means of powers of a linear function over a triangle: complete symmetric polynomials of its values at
    // the corners, over their number of terms.
    const double h1 = x + y + z, h2 = x * x + y * y + z * z + x * y + y * z + z * x;
    const double h3 = x * h2 + y * (y * y + y * z + z * z) + z * z * z;
    flux_[i][0] += through;
    flux_[i][1] += through * h1 / 3;
    flux_[i][2] += through * h2 / 6;
    flux_[i][3] += through * h3 / 10;
  }
}

bool ClosedSurfaceTest::is_closed() const {
  if (!(area_ > 0)) return false;
  for (const auto& of_field : flux_)
    for (const double flux : of_field)
      if (std::abs(flux) > largest_leak * area_) return false;
  return true;
}

}  // namespace vernier
