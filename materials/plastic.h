#pragma once

#include "core/sampling/warp.h"
#include "materials/bsdf_sample.h"
#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/ggx_energy.h"

namespace vernier {

/// Diffuse body under a dielectric GGX surface: glTF's non-metal. The body receives what the surface lets
/// through on the way in and out, (1 - E(wo)) (1 - E(wi)) normalised, which is reciprocal and loses nothing
/// when the body is white; glTF 2.0 Appendix B's own example, 1 - F(h.v), is neither (Ashikhmin and Shirley
/// 2000; Kelemen and Szirmay-Kalos 2001).
struct Plastic {
  Rgb diffuse{1, 1, 1};
  Rgb f0{0.04f, 0.04f, 0.04f};
  Rgb f90{1, 1, 1};
  Ggx ggx;

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z <= 0) return {};
    return eval(wo, wi, body_and_surface(wo));
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u, const Vec2f& v) const {
    const Split split = body_and_surface(wo);
    Vec3f wi;
    Lobe lobe = Lobe::diffuse;
    if (u < split.surface_prob) {
      if (ggx.is_smooth())
        return BsdfSample{reflect(wo), split.surface / split.surface_prob, split.surface_prob, Lobe::delta,
                          1};
      const Vec3f m = ggx.sample_visible(wo, v);
      wi = 2 * dot(wo, m) * m - wo;
      lobe = Lobe::glossy;
    } else {
      wi = sample_cosine_hemisphere(v);
    }
    if (wi.z <= 0) return std::nullopt;
    const BsdfEval value = eval(wo, wi, split);
    if (!(value.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, value.f_cos / value.pdf, value.pdf, lobe, 1};
  }

  Rgb albedo(const Vec3f& wo) const {
    const Split split = body_and_surface(wo);
    return split.body + split.surface;
  }

  SpecularRays specular(const Vec3f& wo) const {
    return {fresnel_schlick(f0, f90, wo.z), {0, 0, 0}, {0, 0, -1}, alpha()};
  }

 private:
  /// Fractions of light from wo that the surface reflects and that the body does, with the lobe choice they
  /// imply.
  struct Split {
    Rgb surface, body;
    float surface_prob;
  };

  float alpha() const { return std::sqrt(ggx.ax * ggx.ay); }
  Rgb surface_albedo(float cos_theta) const {
    return ggx.is_smooth() ? fresnel_schlick(f0, f90, cos_theta)
                           : ggx_albedo(cos_theta, alpha()).with(f0, f90);
  }
  Rgb average_surface_albedo() const {
    return ggx.is_smooth() ? f0 + (f90 - f0) / 21 : ggx_average_albedo(alpha()).with(f0, f90);
  }

  Split body_and_surface(const Vec3f& wo) const {
    Split split;
    split.surface = surface_albedo(wo.z);
    split.body = diffuse * (Rgb(1, 1, 1) - split.surface);
    const float surface = luminance(split.surface), body = luminance(split.body);
    split.surface_prob = surface + body > 0 ? surface / (surface + body) : 0;
    return split;
  }

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi, const Split& split) const {
    const float cosine = cosine_hemisphere_pdf(wi.z);
    const Rgb enters = Rgb(1, 1, 1) - surface_albedo(wi.z);
    const Rgb average = Rgb(1, 1, 1) - average_surface_albedo();
    BsdfEval value;
    for (int c = 0; c < 3; ++c)
      value.f_cos[c] = average[c] > 0 ? split.body[c] * enters[c] / average[c] * cosine : 0;
    value.pdf = (1 - split.surface_prob) * cosine;
    if (ggx.is_smooth()) return value;
    const Vec3f m = normalize(wo + wi);
    const float cos_om = dot(wo, m);
    const float d = ggx.d(m);
    const float lambda_o = ggx.lambda(wo);
    value.f_cos += fresnel_schlick(f0, f90, cos_om) * (d / ((1 + lambda_o + ggx.lambda(wi)) * 4 * wo.z));
    value.pdf += split.surface_prob * d / ((1 + lambda_o) * 4 * wo.z);
    return value;
  }
};

}  // namespace vernier
