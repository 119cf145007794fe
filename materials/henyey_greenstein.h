// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/frame.h"
#include "materials/bsdf_sample.h"

namespace vernier {

/// Phase function of a medium, as a BSDF whose surface looks to any side: the density of the direction in
/// which light goes on, by the angle to the one that it came in (Henyey and Greenstein 1941, "Diffuse
/// Radiation in the Galaxy"). What a medium absorbs is no part of it.
struct HenyeyGreenstein {
  float g = 0;  ///< mean cosine of that angle, in (-1, 1): 0 to all sides alike, above 0 mostly on

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi) const {
    const float pdf = density(wo, wi);
    return {Rgb(pdf), pdf};
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float /*u*/, const Vec2f& v) const {
    const float cosine = sample_cosine(v.x);
    const float sine = std::sqrt(std::max(0.f, 1 - cosine * cosine)), angle = 2 * pi * v.y;
    const Vec3f wi =
        normalize(Frame::from_normal(-wo).to_world({sine * std::cos(angle), sine * std::sin(angle), cosine}));
    return BsdfSample{wi, Rgb(1), density(wo, wi), Lobe::glossy, 1};
  }

  Rgb diffuse(const Vec3f& /*wo*/, const Vec3f& /*wi*/) const { return {0, 0, 0}; }
  Rgb albedo(const Vec3f& /*wo*/) const { return {1, 1, 1}; }
  SpecularRays specular(const Vec3f& /*wo*/) const { return {}; }
  Rgb straight(const Vec3f& /*wo*/) const { return {0, 0, 0}; }
  DeltaLobes delta(const Vec3f& /*wo*/) const { return {}; }

 private:
  /// Per solid angle. The cosine is told by how far apart the unit vectors are, since where it is nearly one
  /// its rounding would be seen.
  float density(const Vec3f& wo, const Vec3f& wi) const {
    const float spread = square(1 - std::abs(g)) + std::abs(g) * length_squared(g < 0 ? wi - wo : wi + wo);
    return (1 - g * g) / (4 * pi * spread * std::sqrt(spread));
  }
  float sample_cosine(float u) const {
    if (std::abs(g) < 1e-3f) return 1 - 2 * u + 1.5f * g * (1 - square(1 - 2 * u));  // to first order in g
    const float ratio = (1 - g * g) / (1 + g - 2 * g * u);
    return std::clamp((1 + g * g - ratio * ratio) / (2 * g), -1.f, 1.f);
  }
};

}  // namespace vernier
