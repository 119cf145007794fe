// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/dielectric.h"
#include "materials/glossy.h"

namespace vernier {

/// glTF's whole base layer: what reflects and what is clear side by side. Appendix B of glTF 2.0 and
/// KHR_materials_transmission mix linearly in metallic and transmission, so the sum is exact.
struct Mixture {
  Glossy glossy;
  float glass_weight = 0;  ///< the rest is glossy; fills the gap between the two
  Dielectric glass;

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi) const {
    if (glass_weight <= 0) return glossy.eval(wo, wi);
    const float prob = glass_prob(wo);
    BsdfEval sum = glossy.eval(wo, wi);
    const BsdfEval value = glass.eval(wo, wi);
    sum.f_cos = sum.f_cos * (1 - glass_weight) + value.f_cos * glass_weight;
    sum.pdf = sum.pdf * (1 - prob) + value.pdf * prob;
    return sum;
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u, const Vec2f& v) const {
    if (glass_weight <= 0) return glossy.sample(wo, u, v);
    const float prob = glass_prob(wo);
    std::optional<BsdfSample> picked;
    if (u < prob) {
      picked = glass.sample(wo, u / prob, v);
      if (picked) scale_delta(*picked, glass_weight, prob);
    } else {
      picked = glossy.sample(wo, std::min((u - prob) / (1 - prob), 0x1.fffffep-1f), v);
      if (picked) scale_delta(*picked, 1 - glass_weight, 1 - prob);
    }
    if (!picked || picked->is_delta()) return picked;
    const BsdfEval value = eval(wo, picked->wi);
    if (!(value.pdf > 0)) return std::nullopt;
    picked->weight = value.f_cos / value.pdf;
    picked->pdf = value.pdf;
    return picked;
  }

  Rgb diffuse(const Vec3f& wo, const Vec3f& wi) const {
    return glossy.diffuse(wo, wi) * (glass_weight > 0 ? 1 - glass_weight : 1);
  }

  Rgb albedo(const Vec3f& wo) const {
    if (glass_weight <= 0) return glossy.albedo(wo);
    return glossy.albedo(wo) * (1 - glass_weight) + glass.albedo(wo) * glass_weight;
  }

  SpecularRays specular(const Vec3f& wo) const {
    if (glass_weight <= 0) return glossy.specular(wo);
    SpecularRays rays = glass.specular(wo);
    rays.transmitted *= glass_weight;
    rays.reflected = glossy.specular(wo).reflected * (1 - glass_weight) + rays.reflected * glass_weight;
    return rays;
  }

  Rgb straight(const Vec3f& wo) const {
    return glass_weight > 0 ? glass.straight(wo) * glass_weight : Rgb(0, 0, 0);
  }

  DeltaLobes delta(const Vec3f& wo) const {
    if (glass_weight <= 0) return glossy.delta(wo);
    DeltaLobes lobes = glass.delta(wo);
    lobes *= glass_weight;
    lobes.reflected += glossy.delta(wo).reflected * (1 - glass_weight);
    return lobes;
  }

 private:
  float glass_prob(const Vec3f& wo) const {
    const float clear = glass_weight * luminance(glass.albedo(wo));
    const float sum = clear + (1 - glass_weight) * luminance(glossy.albedo(wo));
    return sum > 0 ? clear / sum : glass_weight;
  }

  static void scale_delta(BsdfSample& sample, float weight, float prob) {
    if (!sample.is_delta()) return;
    sample.weight *= weight / prob;
    sample.pdf *= prob;
  }
};

}  // namespace vernier
