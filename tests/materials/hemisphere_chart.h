// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/math.h"

namespace vernier::test {

/// One-to-one map between the unit square and the hemisphere of incident directions, in which a scattering
/// lobe of known width fills a good part of the square: polar about the lobe's centre with the logarithm of
/// the angle as radius. No cell of a grid on the square straddles the horizon, and integrals over the square
/// see lobes down to widths of 1e-4 at grazing angles. All in double.
class HemisphereChart {
 public:
  /// Directions reflected from wo, polar about the normal in the space of half vectors (wo + wi) / |wo + wi|.
  static HemisphereChart reflection(const Vec3f& wo, double width);
  /// Directions transmitted without bending, the mirror image of reflection() in the surface.
  static HemisphereChart mirrored(const Vec3f& wo, double width);
  /// Directions refracted from wo by relative index eta, polar about the refracted direction of a smooth
  /// surface; about grazing exit when there is none.
  static HemisphereChart refraction(const Vec3f& wo, double eta, double width);

  /// The direction at `p`; `solid_angle`: its density, steradians per unit of square.
  Vec3d direction(double x, double y, double& solid_angle) const;
  /// Inverse of direction().
  void locate(const Vec3d& wi, double& x, double& y) const;
  /// Whether wi lies in the chart's hemisphere.
  bool contains(const Vec3d& wi) const { return below_ ? wi.z < 0 : wi.z > 0; }

 private:
  HemisphereChart(const Vec3d& wo, const Vec3d& centre, bool half_vector, bool below, double width);
  double largest_angle(double azimuth) const;

  Vec3d wo_, x_, y_, centre_;
  bool half_vector_, below_;
  double width_;
};

}  // namespace vernier::test
