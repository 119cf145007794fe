// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/frame.h"
#include "materials/bsdf.h"

namespace vernier {

/// A BsdfSample in world space.
struct ShadingSample {
  Vec3f wi;
  Rgb weight;
  float pdf, eta;
  bool is_delta, is_transmitted, is_straight, is_diffuse;
};

/// A surface as light meets it from wo: the BSDF in its shading frame, evaluated in world space.
/// Transport between sides that shading and geometric normal disagree about is zero, so that interpolated
/// normals let no light through closed geometry.
class Shading {
 public:
  /// frame.z and ng both on the side of wo (world, unit).
  Shading(const Frame& frame, const Vec3f& ng, const Vec3f& wo, const Bsdf& bsdf)
      : frame_(frame), ng_(ng), wo_(frame.to_local(wo)), bsdf_(bsdf) {}

  /// f |cos| and pdf for the world direction wi.
  BsdfEval eval(const Vec3f& wi) const {
    const Vec3f local = frame_.to_local(wi);
    if (!same_side(local, wi)) return {};
    return bsdf_.eval(wo_, local);
  }

  /// As Bsdf::sample, in world space.
  std::optional<ShadingSample> sample(float u, const Vec2f& v) const {
    const auto local = bsdf_.sample(wo_, u, v);
    if (!local) return std::nullopt;
    const Vec3f wi = frame_.to_world(local->wi);
    if (!same_side(local->wi, wi)) return std::nullopt;
    return ShadingSample{wi,
                         local->weight,
                         local->pdf,
                         local->eta,
                         local->is_delta(),
                         local->is_transmitted(),
                         local->is_straight(),
                         local->lobe == Lobe::diffuse};
  }

  /// Part of what eval() gives that diffuse bodies scatter, in [0, 1].
  Rgb diffuse_share(const Vec3f& wi) const {
    const Rgb all = eval(wi).f_cos, diffuse = bsdf_.diffuse(wo_, frame_.to_local(wi));
    const auto share = [&](int c) { return all[c] > 0 ? std::min(diffuse[c] / all[c], 1.f) : 0; };
    return {share(0), share(1), share(2)};
  }

  /// Whether light from wi passes through the surface.
  bool is_transmitted(const Vec3f& wi) const { return dot(wi, ng_) < 0; }

  Rgb albedo() const { return bsdf_.albedo(wo_); }
  /// Fraction of light that passes on undeflected, toward -wo.
  Rgb straight() const { return bsdf_.straight(wo_); }

  /// What its delta lobes carry toward wo.
  DeltaLobes delta() const { return bsdf_.delta(wo_); }

  /// Directions in world space.
  struct Specular {
    SpecularRays rays;
    Vec3f reflected;
  };
  Specular specular() const {
    Specular result{bsdf_.specular(wo_), frame_.to_world(reflect(wo_))};
    result.rays.refracted = frame_.to_world(result.rays.refracted);
    return result;
  }

  /// Not at a surface, but at a point inside a medium that scatters.
  bool is_in_medium() const { return std::holds_alternative<HenyeyGreenstein>(bsdf_); }

  const Vec3f& normal() const { return frame_.z; }

 private:
  bool same_side(const Vec3f& local, const Vec3f& world) const {
    return (local.z > 0) == (dot(world, ng_) > 0);
  }

  Frame frame_;
  Vec3f ng_, wo_;
  Bsdf bsdf_;
};

}  // namespace vernier
