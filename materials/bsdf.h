// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "materials/dielectric.h"
#include "materials/glossy.h"
#include "materials/henyey_greenstein.h"
#include "materials/lambert.h"
#include "materials/layered.h"
#include "materials/mixture.h"
#include "materials/rough_diffuse.h"

namespace vernier {

/// All models. Made at each hit, by value, with textures already read; the contract is in
/// materials/bsdf_sample.h. A new model is a header of its own and an entry here.
class Bsdf
    : public std::variant<Lambert, Glossy, Dielectric, Mixture, Layered, HenyeyGreenstein, RoughDiffuse> {
 public:
  using variant::variant;

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wo.z < least_cosine || std::abs(wi.z) < least_cosine) return {};
    return std::visit([&](const auto& model) { return model.eval(wo, wi); }, base());
  }
  std::optional<BsdfSample> sample(const Vec3f& wo, float u, const Vec2f& v) const {
    if (wo.z < least_cosine) return std::nullopt;
    auto sample = std::visit([&](const auto& model) { return model.sample(wo, u, v); }, base());
    if (sample && std::abs(sample->wi.z) < least_cosine) sample.reset();
    return sample;
  }
  Rgb diffuse(const Vec3f& wo, const Vec3f& wi) const {
    if (wo.z < least_cosine || std::abs(wi.z) < least_cosine) return {0, 0, 0};
    return std::visit([&](const auto& model) { return model.diffuse(wo, wi); }, base());
  }
  Rgb albedo(const Vec3f& wo) const {
    return std::visit([&](const auto& model) { return model.albedo(wo); }, base());
  }
  SpecularRays specular(const Vec3f& wo) const {
    return std::visit([&](const auto& model) { return model.specular(wo); }, base());
  }
  Rgb straight(const Vec3f& wo) const {
    if (wo.z < least_cosine) return {0, 0, 0};
    return std::visit([&](const auto& model) { return model.straight(wo); }, base());
  }
  DeltaLobes delta(const Vec3f& wo) const {
    if (wo.z < least_cosine) return {};
    return std::visit([&](const auto& model) { return model.delta(wo); }, base());
  }

 private:
  /// Directions nearer to the surface are answered with nothing: models divide by cosines and their squares.
  static constexpr float least_cosine = 1e-7f;

  const variant& base() const { return *this; }
};

// It is copied at each hit.
static_assert(sizeof(Bsdf) <= 224);

}  // namespace vernier
