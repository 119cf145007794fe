// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/sampling/warp.h"
#include "materials/bsdf_sample.h"
#include "materials/eon.h"
#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/tables/ggx_energy.h"

namespace vernier {

/// What lies under a clear surface and scatters diffusely.
struct DiffuseBase {
  Rgb reflected{0, 0, 0};
  Rgb transmitted{0, 0, 0};  ///< to the other side (glTF KHR_materials_diffuse_transmission)
  float eta = 1;  ///< index of the other side over that of the side of wo, where light is bent there too
  Unit16 roughness = 0;  ///< of Eon; 0: Lambertian
  Unit16 part = 1;       ///< of the surface that it lies under, which its colors have been multiplied by

  bool is_rough() const { return !roughness.is_zero(); }
};

/// GGX facets with a diffuse base under them: glTF's metal, its non-metal, and any mixture of both, which all
/// share one lobe of facets because Schlick's reflectance is linear in its parameters.
///
/// A metal's facets give back what they block of each other as a diffuse-like lobe, so that a white metal
/// reflects everything (Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH
/// course). A non-metal's base receives what the surface does not reflect on the way in and out, (1 - E(wo))
/// (1 - E(wi)) normalized, which is reciprocal and loses nothing when the base is white; glTF 2.0 Appendix
/// B's own example, 1 - F(h.v), is neither (Ashikhmin and Shirley 2000; Kelemen and Szirmay-Kalos 2001). E is
/// that of the colour channel that reflects most, so that a coloured surface does not tint the base with its
/// complement (KHR_materials_specular). A rough base is not Lambertian: the same product then loses up to 2 %
/// of the light where wo grazes, and gains none.
class Glossy {
 public:
  static Glossy conductor(const Fresnel& fresnel, const Ggx& ggx);
  static Glossy coated_diffuse(const Fresnel& fresnel, const Ggx& ggx, const DiffuseBase& base);
  /// `metallic` parts of one to the rest of the other, of the same width and film.
  static Glossy mix(const Glossy& coated_diffuse, const Glossy& conductor, float metallic);

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z < 0 && is_black(base_.transmitted)) return {};
    return eval(wo, wi, seen_from(wo));
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u, const Vec2f& v) const {
    const View view = seen_from(wo);
    Vec3f wi;
    Lobe lobe = Lobe::diffuse;
    if (u < view.facet_prob) {
      if (ggx_.is_smooth())
        return BsdfSample{reflect(wo), view.specular_albedo / view.facet_prob, view.facet_prob, Lobe::delta,
                          1};
      const Vec3f m = ggx_.sample_visible(wo, v);
      wi = 2 * dot(wo, m) * m - wo;
      if (wi.z <= 0) return std::nullopt;
      lobe = Lobe::glossy;
    } else {
      wi = base_.is_rough() ? Eon(base_.roughness).sample(wo, v) : sample_cosine_hemisphere(v);
      if (u >= view.facet_prob + view.reflect_prob) wi.z = -wi.z;
    }
    const BsdfEval value = eval(wo, wi, view);
    if (!(value.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, value.f_cos / value.pdf, value.pdf, lobe, wi.z < 0 ? base_.eta : 1};
  }

  Rgb diffuse(const Vec3f& wo, const Vec3f& wi) const {
    return scattered_by_base(seen_from(wo), toward(wi), wo, wi);
  }

  Rgb albedo(const Vec3f& wo) const {
    const GgxAlbedo ggx = ggx_toward(wo);
    return fresnel_.albedo(ggx, wo.z) + multiple_ * ggx.energy_loss +
           body_albedo(wo) * (1 - bound_.albedo(ggx));
  }

  SpecularRays specular(const Vec3f& wo) const {
    return {fresnel_(wo.z), {0, 0, 0}, {0, 0, -1}, ggx_.mean_width()};
  }
  Rgb straight(const Vec3f& /*wo*/) const { return {0, 0, 0}; }
  DeltaLobes delta(const Vec3f& wo) const {
    return ggx_.is_smooth() ? DeltaLobes{seen_from(wo).specular_albedo} : DeltaLobes{};
  }

 private:
  Glossy(const Fresnel& fresnel, const Ggx& ggx) : fresnel_(fresnel), ggx_(ggx) {}

  /// All that depends on wo alone, with the choice among the lobes.
  struct View {
    Rgb specular_albedo;  ///< fraction of light they reflect
    float base_weight;    ///< fraction that gets to the base
    float energy_loss;    ///< fraction that facets block
    float facet_prob, reflect_prob;
  };

  GgxAlbedo ggx_toward(const Vec3f& w) const {
    return ggx_.is_smooth() ? GgxAlbedo{0, schlick_weight(w.z)} : ggx_albedo(w, ggx_);
  }

  View seen_from(const Vec3f& wo) const {
    const GgxAlbedo ggx = ggx_toward(wo);
    View view{fresnel_.albedo(ggx, wo.z), 1 - bound_.albedo(ggx), ggx.energy_loss, 1, 0};
    const float facets = luminance(view.specular_albedo);
    const float reflected =
        luminance(base_.reflected) * view.base_weight + luminance(multiple_) * ggx.energy_loss;
    const float sum = facets + reflected + luminance(base_.transmitted) * view.base_weight;
    if (sum > 0) {
      view.facet_prob = facets / sum;
      view.reflect_prob = reflected / sum;
    }
    return view;
  }

  /// What the facets do with light from wi, on either side.
  GgxAlbedo toward(const Vec3f& wi) const { return ggx_toward({wi.x, wi.y, std::abs(wi.z)}); }

  /// Light that a rough base transmits leaves as what it reflects does, mirrored by the surface.
  Rgb scattered_by_base(const View& view, const GgxAlbedo& toward_wi, const Vec3f& wo,
                        const Vec3f& wi) const {
    float base = view.base_weight * (1 - bound_.albedo(toward_wi)) * base_scale_ *
                 cosine_hemisphere_pdf(std::abs(wi.z));
    if (base_.is_rough()) [[unlikely]] {
      if (wi.z < 0) base /= square(base_.eta);
      const Rgb& color = wi.z < 0 ? base_.transmitted : base_.reflected;
      const Vec3f mirrored(wi.x, wi.y, std::abs(wi.z));
      return Eon(base_.roughness)(color / base_.part, wo, mirrored) * (base * base_.part);
    }
    return wi.z < 0 ? base_.transmitted * (base / square(base_.eta)) : base_.reflected * base;
  }

  Rgb body_albedo(const Vec3f& wo) const {
    if (!base_.is_rough()) return base_.reflected + base_.transmitted;
    const Eon shape(base_.roughness);
    return (shape.albedo(base_.reflected / base_.part, wo.z) +
            shape.albedo(base_.transmitted / base_.part, wo.z)) *
           base_.part;
  }

  BsdfEval eval(const Vec3f& wo, const Vec3f& wi, const View& view) const {
    const GgxAlbedo ggx = toward(wi);
    const float cosine = cosine_hemisphere_pdf(std::abs(wi.z));
    const float drawn = base_.is_rough() ? Eon(base_.roughness).pdf(wo, std::abs(wi.z)) : cosine;
    const Rgb base = scattered_by_base(view, ggx, wo, wi);
    if (wi.z < 0) return {base, std::max(0.f, 1 - view.facet_prob - view.reflect_prob) * drawn};
    const float multiple = view.energy_loss * ggx.energy_loss * multiple_scale_ * cosine;
    BsdfEval value{base + multiple_ * multiple, view.reflect_prob * drawn};
    if (ggx_.is_smooth()) return value;
    const Vec3f m = normalize(wo + wi);
    const float lambda_o = ggx_.lambda(wo);
    const float d = ggx_.d(m) / (4 * wo.z);
    value.f_cos += fresnel_(dot(wo, m)) * (d / (1 + lambda_o + ggx_.lambda(wi)));
    value.pdf += view.facet_prob * d / (1 + lambda_o);
    return value;
  }

  Fresnel fresnel_;
  Ggx ggx_;
  DiffuseBase base_;
  SchlickCurve bound_;        ///< of what the surface over the base reflects
  float base_scale_ = 0;      ///< 1 / (1 - its mean)
  Rgb multiple_{0, 0, 0};     ///< colour of light that met more than one facet
  float multiple_scale_ = 0;  ///< 1 / mean of what facets block
};

}  // namespace vernier
