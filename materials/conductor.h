#pragma once

#include "core/sampling/warp.h"
#include "materials/bsdf_sample.h"
#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/ggx_energy.h"

namespace vernier {

/// Metal: GGX reflection with Schlick's Fresnel, plus what single scattering loses between facets, returned
/// as a diffuse-like lobe so that a white metal reflects everything (Kulla and Conty 2017, "Revisiting
/// Physically Based Shading at Imageworks", SIGGRAPH course).
struct Conductor {
  Rgb f0{1, 1, 1};
  Rgb f90{1, 1, 1};
  Ggx ggx;

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z <= 0 || ggx.is_smooth()) return {};
    const Compensation compensation = compensate(wo);
    const Vec3f m = normalize(wo + wi);
    const float cos_om = dot(wo, m);
    const Rgb single = fresnel_schlick(f0, f90, cos_om) * (ggx.d(m) * ggx.g2(wo, wi) / (4 * wo.z));
    const Rgb multiple = compensation.scale * (missing(wi.z) * wi.z * inv_pi);
    const float pdf = (1 - compensation.prob) * ggx.visible_pdf(wo, m) / (4 * cos_om) +
                      compensation.prob * cosine_hemisphere_pdf(wi.z);
    return {single + multiple, pdf};
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u, const Vec2f& v) const {
    if (ggx.is_smooth()) return BsdfSample{reflect(wo), fresnel_schlick(f0, f90, wo.z), 1, Lobe::delta, 1};
    Vec3f wi;
    if (u < compensate(wo).prob) {
      wi = sample_cosine_hemisphere(v);
    } else {
      const Vec3f m = ggx.sample_visible(wo, v);
      wi = 2 * dot(wo, m) * m - wo;
    }
    const BsdfEval value = eval(wo, wi);
    if (!(value.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, value.f_cos / value.pdf, value.pdf, Lobe::glossy, 1};
  }

  Rgb albedo(const Vec3f& wo) const {
    if (ggx.is_smooth()) return fresnel_schlick(f0, f90, wo.z);
    const GgxAlbedo directional = ggx_albedo(wo.z, alpha());
    return directional.with(f0, f90) + multiple_reflectance() * directional.missing;
  }

  SpecularRays specular(const Vec3f& wo) const {
    return {fresnel_schlick(f0, f90, wo.z), {0, 0, 0}, {0, 0, -1}, alpha()};
  }

 private:
  /// The multiple-scattering lobe seen from wo: f_ms cos = scale (1 - E(wi)) cos / pi, chosen with
  /// probability prob.
  struct Compensation {
    Rgb scale;
    float prob;
  };

  float alpha() const { return std::sqrt(ggx.ax * ggx.ay); }
  float missing(float cos_theta) const { return ggx_albedo(cos_theta, alpha()).missing; }

  Compensation compensate(const Vec3f& wo) const {
    const float prob = missing(wo.z);
    return {multiple_reflectance() * (prob / ggx_average_albedo(alpha()).missing), prob};
  }

  /// Colour of light that met more than one facet: each further bounce is reflected by the mean Fresnel
  /// reflectance (Kulla and Conty 2017; mean of Schlick's over the hemisphere is f0 + (f90 - f0) / 21).
  Rgb multiple_reflectance() const {
    const Rgb f = f0 + (f90 - f0) / 21;
    const float e = 1 - ggx_average_albedo(alpha()).missing;
    Rgb result;
    for (int c = 0; c < 3; ++c) result[c] = f[c] * f[c] * e / (1 - f[c] * (1 - e));
    return result;
  }
};

}  // namespace vernier
