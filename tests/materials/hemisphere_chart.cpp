// SPDX-License-Identifier: Apache-2.0
#include "tests/materials/hemisphere_chart.h"

namespace vernier::test {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

Vec3d flipped(const Vec3d& w) { return {w.x, w.y, -w.z}; }

}  // namespace

// The azimuth is measured from x_: for half vectors the azimuth of wo, else the direction that leads from the
// centre to the normal, so that the horizon is farthest, or nearest, at azimuth zero.
HemisphereChart::HemisphereChart(const Vec3d& wo, const Vec3d& centre, bool half_vector, bool below,
                                 double width)
    : wo_(wo), centre_(centre), half_vector_(half_vector), below_(below), width_(width) {
  const Vec3d toward = half_vector ? Vec3d(wo.x, wo.y, 0) : Vec3d(0, 0, 1) - centre.z * centre;
  x_ = length(toward) > 1e-9 ? normalize(toward) : Vec3d(1, 0, 0);
  y_ = cross(centre_, x_);
}

HemisphereChart HemisphereChart::reflection(const Vec3f& wo, double width) {
  return {normalize(Vec3d(wo)), {0, 0, 1}, true, false, width};
}

HemisphereChart HemisphereChart::mirrored(const Vec3f& wo, double width) {
  return {normalize(Vec3d(wo)), {0, 0, 1}, true, true, width};
}

HemisphereChart HemisphereChart::refraction(const Vec3f& wo, double eta, double width) {
  const Vec3d w = normalize(Vec3d(wo));
  Vec3d centre(-w.x / eta, -w.y / eta, 0);
  const double sine = length(centre);
  constexpr double steepest = 0.9998;  // of the centre's sine, so that the chart has room on both sides of it
  if (sine > steepest) centre *= steepest / sine;
  centre.z = -std::sqrt(1 - dot(centre, centre));
  return {w, centre, false, true, width};
}

/// Polar angle at which wi meets the horizon.
double HemisphereChart::largest_angle(double azimuth) const {
  if (half_vector_) {
    const double sine = std::sqrt(wo_.x * wo_.x + wo_.y * wo_.y);
    return (std::numbers::pi / 2 + std::atan2(sine * std::cos(azimuth), wo_.z)) / 2;
  }
  return std::numbers::pi / 2 - std::atan2(x_.z * std::cos(azimuth), -centre_.z);
}

Vec3d HemisphereChart::direction(double x, double y, double& solid_angle) const {
  const double azimuth = two_pi * y;
  const double range = std::log1p(largest_angle(azimuth) / width_);
  const double angle = width_ * std::expm1(x * range);
  const double sine = std::sin(angle);
  const Vec3d axis =
      sine * std::cos(azimuth) * x_ + sine * std::sin(azimuth) * y_ + std::cos(angle) * centre_;
  solid_angle = sine * two_pi * range * (angle + width_);
  if (!half_vector_) return axis;
  const double cosine = dot(wo_, axis);
  solid_angle *= 4 * cosine;
  const Vec3d wi = 2 * cosine * axis - wo_;
  return below_ ? flipped(wi) : wi;
}

void HemisphereChart::locate(const Vec3d& wi, double& x, double& y) const {
  const Vec3d axis = half_vector_ ? normalize(wo_ + (below_ ? flipped(wi) : wi)) : wi;
  const double a = dot(axis, x_), b = dot(axis, y_);
  const double angle = std::atan2(std::sqrt(a * a + b * b), dot(axis, centre_));
  const double azimuth = std::atan2(b, a);
  y = azimuth / two_pi;
  if (y < 0) y += 1;
  x = std::log1p(angle / width_) / std::log1p(largest_angle(azimuth) / width_);
}

}  // namespace vernier::test
