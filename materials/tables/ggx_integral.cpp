// SPDX-License-Identifier: Apache-2.0
#include "materials/tables/ggx_integral.h"

#include "materials/fresnel.h"
#include "materials/tables/gauss_nodes.h"

namespace vernier {
namespace {

struct Sums {
  double total = 0;   ///< integral of G2 D (o.m) / o.z over facet normals
  double excess = 0;  ///< the same times the grazing reflectance less that of a smooth surface
};

/// Integral over the normals m of one azimuth `phi` of facets, in units where it is uniform: up to where the
/// reflected direction meets the horizon, the polar angle stretched by 1 / width, so that the integrand is
/// smooth.
void add_azimuth(Sums& sums, const Vec3f& wo, const Ggx& ggx, float phi, float weight) {
  const Vec2f slope(ggx.ax * std::cos(phi), ggx.ay * std::sin(phi));
  const float width = std::sqrt(slope.x * slope.x + slope.y * slope.y);
  const Vec2f toward = slope / width;
  const float horizon = (pi / 2 + std::atan2(wo.x * toward.x + wo.y * toward.y, wo.z)) / 2;
  const float range = std::atan(std::tan(horizon) / width);
  const float lambda_o = ggx.lambda(wo), smooth = schlick_weight(wo.z);
  for_each_gauss_node<10>([&](float x, float w) {
    const float stretched = range * (1 - (1 - x) * (1 - x) * (1 - x));
    const float sine = std::sin(stretched), cosine = std::cos(stretched);
    const float tan_m = width * sine / cosine;
    const float cos_m = 1 / std::sqrt(1 + tan_m * tan_m), sin_m = tan_m * cos_m;
    const Vec3f m(sin_m * toward.x, sin_m * toward.y, cos_m);
    const float cos_om = dot(wo, m);
    const Vec3f wi = 2 * cos_om * m - wo;
    if (cos_om <= 0 || wi.z <= 0) return;
    const float density = 6 * range * (1 - x) * (1 - x) * sine * cosine;
    const double value = weight * w * density * cos_om / (wo.z * cos_m * (1 + lambda_o + ggx.lambda(wi)));
    sums.total += value;
    sums.excess += value * (schlick_weight(cos_om) - smooth);
  });
}

}  // namespace

GgxAlbedo integrate_ggx_albedo(const Vec3f& wo, const Ggx& ggx) {
  // Where the azimuth of m is square to that of wo the horizon moves fastest: azimuths are dense there. A
  // lobe that is the same on both sides of wo needs one side only.
  const float square_azimuth = std::atan2(wo.x * ggx.ax, -wo.y * ggx.ay);
  const bool symmetric = ggx.ax == ggx.ay;
  Sums sums;
  for_each_gauss_node<7>([&](float x, float w) {
    const float offset = (pi / 2) * x * x, weight = symmetric ? w * x : w * x / 2;
    add_azimuth(sums, wo, ggx, square_azimuth + offset, weight);
    add_azimuth(sums, wo, ggx, square_azimuth - offset, weight);
    if (symmetric) return;
    add_azimuth(sums, wo, ggx, square_azimuth + pi + offset, weight);
    add_azimuth(sums, wo, ggx, square_azimuth + pi - offset, weight);
  });
  return {float(1 - sums.total), float(sums.excess)};
}

}  // namespace vernier
