// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/sampling/warp.h"
#include "materials/bsdf_sample.h"

namespace vernier {

/// Ideal diffuse reflection: f = albedo / pi.
struct Lambert {
  Rgb reflectance{0, 0, 0};

  BsdfEval eval(const Vec3f& /*wo*/, const Vec3f& wi) const {
    if (wi.z <= 0) return {};
    const float pdf = cosine_hemisphere_pdf(wi.z);
    return {reflectance * pdf, pdf};
  }

  std::optional<BsdfSample> sample(const Vec3f& /*wo*/, float /*u*/, const Vec2f& v) const {
    const Vec3f wi = sample_cosine_hemisphere(v);
    if (wi.z <= 0) return std::nullopt;
    return BsdfSample{wi, reflectance, cosine_hemisphere_pdf(wi.z), Lobe::diffuse, 1};
  }

  Rgb diffuse(const Vec3f& wo, const Vec3f& wi) const { return eval(wo, wi).f_cos; }
  Rgb albedo(const Vec3f& /*wo*/) const { return reflectance; }
  SpecularRays specular(const Vec3f& /*wo*/) const { return {}; }
  Rgb straight(const Vec3f& /*wo*/) const { return {0, 0, 0}; }
  DeltaLobes delta(const Vec3f& /*wo*/) const { return {}; }
};

}  // namespace vernier
