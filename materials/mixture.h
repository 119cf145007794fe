#pragma once

#include "materials/conductor.h"
#include "materials/dielectric.h"
#include "materials/plastic.h"

namespace vernier {

/// glTF's whole base layer: metal, opaque non-metal and clear dielectric side by side, weights adding to 1. Appendix B
/// of glTF 2.0 and KHR_materials_transmission mix linearly in metallic and transmission, so the sum is exact.
struct Mixture {
  Conductor metal;
  Plastic plastic;
  Dielectric glass;
  float metal_weight = 0, plastic_weight = 1, glass_weight = 0;

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi) const {
    const Choice choice = choose(wo);
    BsdfEval sum;
    add(sum, metal, metal_weight, choice.metal, wo, wi);
    add(sum, plastic, plastic_weight, choice.plastic, wo, wi);
    add(sum, glass, glass_weight, choice.glass, wo, wi);
    return sum;
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u, const Vec2f& v) const {
    const Choice choice = choose(wo);
    std::optional<BsdfSample> picked;
    float prob, weight;
    if (u < choice.metal) {
      prob = choice.metal;
      weight = metal_weight;
      picked = metal.sample(wo, u / prob, v);
    } else if (u < choice.metal + choice.plastic) {
      prob = choice.plastic;
      weight = plastic_weight;
      picked = plastic.sample(wo, std::min((u - choice.metal) / prob, 0x1.fffffep-1f), v);
    } else {
      prob = choice.glass;
      weight = glass_weight;
      if (prob <= 0) return std::nullopt;
      picked = glass.sample(wo, std::min((u - choice.metal - choice.plastic) / prob, 0x1.fffffep-1f), v);
    }
    if (!picked) return std::nullopt;
    if (picked->is_delta()) {
      picked->weight *= weight / prob;
      picked->pdf *= prob;
      return picked;
    }
    const BsdfEval value = eval(wo, picked->wi);
    if (!(value.pdf > 0)) return std::nullopt;
    picked->weight = value.f_cos / value.pdf;
    picked->pdf = value.pdf;
    return picked;
  }

  Rgb albedo(const Vec3f& wo) const {
    return metal.albedo(wo) * metal_weight + plastic.albedo(wo) * plastic_weight + glass.albedo(wo) * glass_weight;
  }

  SpecularRays specular(const Vec3f& wo) const {
    SpecularRays rays = glass.specular(wo);
    rays.transmitted *= glass_weight;
    rays.reflected = metal.specular(wo).reflected * metal_weight + plastic.specular(wo).reflected * plastic_weight +
                     rays.reflected * glass_weight;
    return rays;
  }

 private:
  struct Choice {
    float metal, plastic, glass;
  };

  Choice choose(const Vec3f& wo) const {
    const float m = metal_weight > 0 ? metal_weight * luminance(metal.albedo(wo)) : 0;
    const float p = plastic_weight > 0 ? plastic_weight * luminance(plastic.albedo(wo)) : 0;
    const float g = glass_weight > 0 ? glass_weight * luminance(glass.albedo(wo)) : 0;
    const float sum = m + p + g;
    if (!(sum > 0)) return {metal_weight, plastic_weight, glass_weight};
    return {m / sum, p / sum, g / sum};
  }

  template <typename Model>
  static void add(BsdfEval& sum, const Model& model, float weight, float prob, const Vec3f& wo, const Vec3f& wi) {
    if (weight <= 0) return;
    const BsdfEval value = model.eval(wo, wi);
    sum.f_cos += value.f_cos * weight;
    sum.pdf += value.pdf * prob;
  }
};

}  // namespace vernier
