// SPDX-License-Identifier: Apache-2.0
#include "materials/layered.h"

namespace vernier {

Layered::View Layered::seen_from(const Vec3f& wo) const {
  View view{coat_.frame(wo), 0, 0, 0};
  if (coat_) view.coat = coat_.reflectance(dot(wo, view.frame.z));
  const float sheen = sheen_ ? (1 - view.coat) * luminance(sheen_.albedo(wo.z)) : 0;
  const float below = (1 - view.coat) * (sheen_ ? sheen_.base_scale(wo.z) : 1);
  const float sum = view.coat + sheen + below * luminance(base_.albedo(wo));
  if (sum > 0) {
    view.coat_prob = view.coat / sum;
    view.sheen_prob = sheen / sum;
  }
  return view;
}

BsdfEval Layered::eval(const Vec3f& wo, const Vec3f& wi, const View& view) const {
  BsdfEval sum = base_.eval(wo, wi);
  sum.f_cos *= base_scale(wo, wi, view);
  sum.pdf *= std::max(0.f, 1 - view.coat_prob - view.sheen_prob);
  if (wi.z <= 0) return sum;
  if (sheen_) {
    sum.f_cos += sheen_.f_cos(wo, wi) * (1 - view.coat);
    sum.pdf += view.sheen_prob * 2 * sphere_pdf();
  }
  const Vec3f coat_wi = view.frame.to_local(wi);
  if (coat_ && coat_wi.z > 1e-6f) {
    const BsdfEval value = coat_.facets().eval(view.frame.to_local(wo), coat_wi);
    sum.f_cos += value.f_cos * view.coat;
    sum.pdf += value.pdf * view.coat_prob;
  }
  return sum;
}

std::optional<BsdfSample> Layered::sample_coat(const Vec3f& wo, float u, const Vec2f& v,
                                               const View& view) const {
  auto sample = coat_.facets().sample(view.frame.to_local(wo), std::min(u, 0x1.fffffep-1f), v);
  if (!sample || sample->wi.z <= 1e-6f) return std::nullopt;
  sample->wi = view.frame.to_world(sample->wi);
  if (sample->wi.z <= 0) return std::nullopt;  // below the horizon of the layer below
  return sample;
}

/// Fibres scatter over all directions, most of it toward grazing ones.
std::optional<BsdfSample> Layered::sample_sheen(const Vec2f& v) {
  Vec3f wi = sample_sphere(v);
  wi.z = std::abs(wi.z);
  if (wi.z == 0) return std::nullopt;
  return BsdfSample{wi, {0, 0, 0}, 0, Lobe::glossy, 1};
}

DeltaLobes Layered::delta(const Vec3f& wo) const {
  const View view = seen_from(wo);
  DeltaLobes lobes = base_.delta(wo);
  lobes.reflected *= base_scale(wo, reflect(wo), view);
  // Fibres ask for the cosine of what is transmitted, and nothing else of its direction.
  const float cos_t = safe_sqrt(1 - (1 - square(wo.z)) / square(lobes.eta));
  lobes.transmitted *= base_scale(wo, {0, 0, -cos_t}, view);
  if (coat_ && coat_.normal == Vec3f(0, 0, 1))
    lobes.reflected += coat_.facets().delta(wo).reflected * view.coat;
  return lobes;
}

SpecularRays Layered::specular(const Vec3f& wo) const {
  const View view = seen_from(wo);
  SpecularRays rays = base_.specular(wo);
  if (coat_ && coat_.alpha < rays.alpha) return {Rgb(view.coat), {0, 0, 0}, {0, 0, -1}, coat_.alpha};
  const float scale = base_scale(wo, wo, view);
  rays.reflected = rays.reflected * scale + Rgb(view.coat);
  rays.transmitted *= scale;
  return rays;
}

}  // namespace vernier
