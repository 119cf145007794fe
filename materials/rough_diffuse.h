// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/bsdf_sample.h"
#include "materials/eon.h"

namespace vernier {

/// A matte surface that is rough (glTF KHR_materials_diffuse_roughness).
struct RoughDiffuse {
  Rgb reflectance{0, 0, 0};
  Eon shape{0};

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z <= 0) return {};
    return {shape(reflectance, wo, wi) * (wi.z * inv_pi), shape.pdf(wo, wi.z)};
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float /*u*/, const Vec2f& v) const {
    const Vec3f wi = shape.sample(wo, v);
    if (wi.z <= 0) return std::nullopt;
    const BsdfEval value = eval(wo, wi);
    return BsdfSample{wi, value.f_cos / value.pdf, value.pdf, Lobe::diffuse, 1};
  }

  Rgb diffuse(const Vec3f& wo, const Vec3f& wi) const { return eval(wo, wi).f_cos; }
  Rgb albedo(const Vec3f& wo) const { return shape.albedo(reflectance, wo.z); }
  SpecularRays specular(const Vec3f& /*wo*/) const { return {}; }
  Rgb straight(const Vec3f& /*wo*/) const { return {0, 0, 0}; }
  DeltaLobes delta(const Vec3f& /*wo*/) const { return {}; }
};

}  // namespace vernier
