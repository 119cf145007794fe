// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/clearcoat.h"
#include "materials/mixture.h"
#include "materials/sheen.h"

namespace vernier {

/// glTF's base layer under sheen, under a clear coat; either may be missing.
class Layered {
 public:
  Layered(const Mixture& base, const Sheen& sheen, const Clearcoat& coat)
      : base_(base), sheen_(sheen), coat_(coat) {}

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi) const { return eval(wo, wi, seen_from(wo)); }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u, const Vec2f& v) const {
    const View view = seen_from(wo);
    std::optional<BsdfSample> picked;
    if (u < view.coat_prob) {
      picked = sample_coat(wo, u / view.coat_prob, v, view);
      if (picked) scale_delta(*picked, view.coat, view.coat_prob);
    } else if (u < view.coat_prob + view.sheen_prob) {
      picked = sample_sheen(v);
    } else if (const float prob = 1 - view.coat_prob - view.sheen_prob; prob > 0) {
      picked = base_.sample(wo, std::min((u - view.coat_prob - view.sheen_prob) / prob, 0x1.fffffep-1f), v);
      if (picked) scale_delta(*picked, base_scale(wo, picked->wi, view), prob);
    }
    if (!picked || picked->is_delta()) return picked;
    const BsdfEval value = eval(wo, picked->wi, view);
    if (!(value.pdf > 0)) return std::nullopt;
    picked->weight = value.f_cos / value.pdf;
    picked->pdf = value.pdf;
    return picked;
  }

  Rgb diffuse(const Vec3f& wo, const Vec3f& wi) const {
    return base_.diffuse(wo, wi) * base_scale(wo, wi, seen_from(wo));
  }

  Rgb albedo(const Vec3f& wo) const {
    const float coat = coat_.reflectance(coat_.frame(wo).to_local(wo).z);
    return Rgb(coat) + (sheen_.albedo(wo.z) + base_.albedo(wo) * sheen_.base_scale(wo.z)) * (1 - coat);
  }

  SpecularRays specular(const Vec3f& wo) const;
  Rgb straight(const Vec3f& wo) const { return base_.straight(wo) * base_scale(wo, -wo, seen_from(wo)); }
  /// A coat whose normal is another than the base's is left out: it reflects to another side.
  DeltaLobes delta(const Vec3f& wo) const;

 private:
  /// All that depends on wo alone, with the choice among the layers.
  struct View {
    Frame frame;  ///< of the coat
    float coat;   ///< fraction of light it reflects
    float coat_prob, sheen_prob;
  };

  View seen_from(const Vec3f& wo) const;
  BsdfEval eval(const Vec3f& wo, const Vec3f& wi, const View& view) const;
  std::optional<BsdfSample> sample_coat(const Vec3f& wo, float u, const Vec2f& v, const View& view) const;
  static std::optional<BsdfSample> sample_sheen(const Vec2f& v);
  float base_scale(const Vec3f& wo, const Vec3f& wi, const View& view) const {
    return (1 - view.coat) * (sheen_ ? sheen_.base_scale(wo, wi) : 1);
  }
  static void scale_delta(BsdfSample& sample, float weight, float prob) {
    if (!sample.is_delta()) return;
    sample.weight *= weight / prob;
    sample.pdf *= prob;
  }

  Mixture base_;
  Sheen sheen_;
  Clearcoat coat_;
};

}  // namespace vernier
