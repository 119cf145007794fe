// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "materials/bsdf_sample.h"
#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/tables/dielectric_albedo.h"

namespace vernier {

/// Relative indices of a boundary that bends colours differently, red, green, blue, with their energy tables.
struct Dispersion {
  std::array<float, 3> eta;
  std::array<const DielectricAlbedo*, 3> energy;

  /// The one of these indices, kept for good. May be called from any thread.
  static const Dispersion& of(const std::array<float, 3>& eta);
};

/// Clear boundary, smooth or GGX-rough, with exact Fresnel reflectance (Walter et al. 2007, eqs. 20, 21).
/// With `thin` the surface is a sheet of no thickness: what passes is not bent, and rough sheets blur it like
/// the mirrored reflection lobe (glTF KHR_materials_transmission).
///
/// What one bounce on the facets loses, up to half the light for wide lobes seen from inside, is given back
/// by dividing both lobes by the directional albedo (Turquin 2019, "Practical multiple scattering
/// compensation for microfacet models"): it keeps the shape of the lobes and needs no further one, but rough
/// glass is therefore reciprocal only up to the ratio of the two albedos.
struct Dielectric {
  float eta = 1.5f;  ///< index of the far side over that of the side of wo
  Ggx ggx;
  Rgb tint{1, 1, 1};  ///< multiplies what is transmitted
  /// Reflectance of the outer side at normal and grazing incidence, between which it follows Fresnel's curve;
  /// f0 of the index for clear glass. What the most reflected colour channel leaves is transmitted
  /// (KHR_materials_specular).
  Fresnel fresnel{};
  bool thin = false;
  const DielectricAlbedo* energy = nullptr;  ///< of eta; needed when rough and not thin
  const Dispersion* dispersion = nullptr;    ///< indices of the three colours, if they differ

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi) const {
    if (dispersion) return eval_dispersed(wo, wi);
    if (is_delta()) return {};
    BsdfEval value = single_scattering(wo, wi);
    if (value.pdf > 0) value.f_cos /= single_albedo(wo);
    return value;
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u, const Vec2f& v) const {
    if (dispersion) return sample_dispersed(wo, u, v);
    const bool smooth = is_delta();
    const Vec3f m = smooth ? Vec3f(0, 0, 1) : ggx.sample_visible(wo, v);
    const float cos_om = dot(wo, m);
    const Split split = boundary(cos_om);
    const bool reflects = u < split.prob;
    Vec3f wi;
    if (reflects || thin) {
      wi = 2 * cos_om * m - wo;
      if (wi.z <= 0) return std::nullopt;
      if (!reflects) wi = smooth ? -wo : Vec3f(wi.x, wi.y, -wi.z);
    } else {
      wi = refract(wo, m, cos_om, split.cos_t);
      if (wi.z >= 0) return std::nullopt;
    }
    const float bent = reflects || thin ? 1 : eta;
    if (smooth) {
      const float prob = reflects ? split.prob : 1 - split.prob;
      const Rgb weight = reflects ? split.reflected : split.transmitted / (bent * bent);
      return BsdfSample{wi, weight / prob, prob, Lobe::delta, bent};
    }
    const BsdfEval value = eval(wo, wi);
    if (!(value.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, value.f_cos / value.pdf, value.pdf, Lobe::glossy, bent};
  }

  Rgb diffuse(const Vec3f& /*wo*/, const Vec3f& /*wi*/) const { return {0, 0, 0}; }

  Rgb albedo(const Vec3f& wo) const {
    const Split split = boundary(wo.z);
    return split.reflected + split.transmitted;
  }

  /// Thin sheets narrower than this count as smooth: they blur what is behind them by less than a tenth of a
  /// degree, and a lamp seen through a narrower lobe would hardly ever be found by chance.
  static constexpr float clear_limit = 2e-3f;

  Rgb straight(const Vec3f& wo) const {
    if (dispersion) {
      Rgb sum(0, 0, 0);
      for (int c = 0; c < 3; ++c) sum[c] = of_channel(c).straight(wo)[c];
      return sum;
    }
    return is_delta() && (thin || eta == 1) ? boundary(wo.z).transmitted : Rgb(0, 0, 0);
  }

  DeltaLobes delta(const Vec3f& wo) const {
    if (dispersion) {
      Rgb reflected(0, 0, 0);
      for (int c = 0; c < 3; ++c) reflected[c] = of_channel(c).delta(wo).reflected[c];
      return {reflected};
    }
    if (!is_delta()) return {};
    const Split split = boundary(wo.z);
    const float bent = thin ? 1 : eta;
    return {split.reflected, split.transmitted / (bent * bent), bent};
  }

  SpecularRays specular(const Vec3f& wo) const {
    const Split split = boundary(wo.z);
    const float bent = thin ? 1 : eta;
    const Vec3f through = thin ? -wo : refract(wo, {0, 0, 1}, wo.z, split.cos_t);
    return {split.reflected, split.transmitted / (bent * bent), through, is_delta() ? 0 : ggx.mean_width()};
  }

  /// This boundary for one colour of its dispersion.
  Dielectric of_channel(int c) const {
    Dielectric result = *this;
    result.eta = dispersion->eta[size_t(c)];
    result.energy = dispersion->energy[size_t(c)];
    result.dispersion = nullptr;
    return result;
  }

 private:
  struct Split {
    Rgb reflected, transmitted;
    float prob;   ///< of choosing reflection
    float cos_t;  ///< of the refracted direction
  };

  Split boundary(float cos_om) const {
    Split split;
    const float exact = fresnel_dielectric(cos_om, eta, split.cos_t);
    if (exact >= 1 && !thin) {
      split.reflected = Rgb(1, 1, 1);
      split.transmitted = Rgb(0, 0, 0);
      split.prob = 1;
      return split;
    }
    const float cos_outside = eta < 1 && !thin ? split.cos_t : cos_om;
    split.reflected = fresnel.along(exact, f0_from_ior(eta), cos_outside);
    split.transmitted = tint * (1 - max_component(split.reflected));
    const float r = max_component(split.reflected), t = max_component(split.transmitted);
    split.prob = r + t > 0 ? r / (r + t) : 1;
    return split;
  }

  BsdfEval single_scattering(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z > 0) return eval_reflection(wo, wi);
    if (thin) {
      const Vec3f mirrored(wi.x, wi.y, -wi.z);
      const Vec3f m = normalize(wo + mirrored);
      const Split split = boundary(dot(wo, m));
      const float visible = ggx.visible_pdf(wo, m) / (4 * dot(wo, m));
      return {split.transmitted * (visible * ggx.g2(wo, mirrored) / ggx.g1(wo)), (1 - split.prob) * visible};
    }
    // Generalised half vector, turned to the side of wo.
    Vec3f m = normalize(wo + eta * wi);
    if (m.z < 0) m = -m;
    const float cos_om = dot(wo, m), cos_im = dot(wi, m);
    if (cos_om <= 0 || cos_im >= 0) return {};
    const Split split = boundary(cos_om);
    const float jacobian = eta * eta * -cos_im / square(cos_om + eta * cos_im);
    const float visible = ggx.visible_pdf(wo, m) * jacobian;
    // f cos / pdf of the lobe is G2/G1 / eta^2: radiance is compressed by the squared index.
    const float shadowing = (1 + ggx.lambda(wo)) / (1 + ggx.lambda(wo) + ggx.lambda(-wi));
    return {split.transmitted * (visible * shadowing / (eta * eta)), (1 - split.prob) * visible};
  }

  /// Fraction of light that single_scattering() returns when it absorbs none.
  float single_albedo(const Vec3f& wo) const {
    if (thin) return 1 - ggx_albedo(wo, ggx).energy_loss;
    return energy->albedo(wo.z, ggx.mean_width(), {max_component(fresnel.f0), fresnel.f90});
  }

  bool is_delta() const {
    return thin ? std::max(ggx.ax, ggx.ay) < clear_limit : ggx.is_smooth() || eta == 1;
  }

  Vec3f refract(const Vec3f& wo, const Vec3f& m, float cos_om, float cos_t) const {
    return (cos_om / eta - cos_t) * m - wo / eta;
  }

  BsdfEval eval_reflection(const Vec3f& wo, const Vec3f& wi) const {
    const Vec3f m = normalize(wo + wi);
    const float cos_om = dot(wo, m);
    if (cos_om <= 0) return {};
    const Split split = boundary(cos_om);
    const float visible = ggx.visible_pdf(wo, m) / (4 * cos_om);
    return {split.reflected * (visible * ggx.g2(wo, wi) / ggx.g1(wo)), split.prob * visible};
  }

  /// Each colour is scattered by its own index; sample() picks one in three, and so the densities are
  /// averaged.
  BsdfEval eval_dispersed(const Vec3f& wo, const Vec3f& wi) const {
    BsdfEval sum;
    for (int c = 0; c < 3; ++c) {
      const BsdfEval value = of_channel(c).eval(wo, wi);
      sum.f_cos[c] = value.f_cos[c];
      sum.pdf += value.pdf / 3;
    }
    return sum;
  }

  std::optional<BsdfSample> sample_dispersed(const Vec3f& wo, float u, const Vec2f& v) const {
    const int chosen = std::min(int(3 * u), 2);
    auto sample = of_channel(chosen).sample(wo, std::min(3 * u - float(chosen), 0x1.fffffep-1f), v);
    if (!sample) return sample;
    if (!sample->is_delta()) {
      const BsdfEval value = eval_dispersed(wo, sample->wi);
      sample->weight = value.f_cos / value.pdf;
      sample->pdf = value.pdf;
    } else if (sample->is_transmitted()) {
      // No other colour goes this way.
      const float weight = sample->weight[chosen];
      sample->weight = Rgb(0, 0, 0);
      sample->weight[chosen] = 3 * weight;
      sample->pdf /= 3;
    } else {
      Rgb reflected(0, 0, 0);
      float prob = 0;
      for (int c = 0; c < 3; ++c) {
        const Dielectric channel = of_channel(c);
        if (!channel.is_delta()) continue;  // a rough boundary of another index, whose lobe eval() knows
        const Split split = channel.boundary(wo.z);
        reflected[c] = split.reflected[c];
        prob += split.prob / 3;
      }
      sample->weight = reflected / prob;
      sample->pdf = prob;
    }
    return sample;
  }
};

}  // namespace vernier
