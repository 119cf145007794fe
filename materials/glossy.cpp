// SPDX-License-Identifier: Apache-2.0
#include "materials/glossy.h"

namespace vernier {
namespace {

GgxAlbedo average(const Ggx& ggx) {
  return ggx.is_smooth() ? GgxAlbedo{0, 1 / 21.f} : ggx_average_albedo(ggx);
}

Rgb mix(float t, const Rgb& a, const Rgb& b) { return a * (1 - t) + b * t; }

}  // namespace

Glossy Glossy::conductor(const Fresnel& fresnel, const Ggx& ggx) {
  Glossy result(fresnel, ggx);
  const float missing = average(ggx).energy_loss;
  if (missing <= 0) return result;
  // Each further bounce is reflected by the mean Fresnel reflectance (Kulla and Conty 2017).
  const Rgb f = fresnel.mean();
  for (int c = 0; c < 3; ++c) result.multiple_[c] = f[c] * f[c] * (1 - missing) / (1 - f[c] * missing);
  result.multiple_scale_ = 1 / missing;
  return result;
}

Glossy Glossy::coated_diffuse(const Fresnel& fresnel, const Ggx& ggx, const DiffuseBase& base) {
  Glossy result(fresnel, ggx);
  result.base_ = base;
  result.bound_ = fresnel.bound();
  const float entering = 1 - result.bound_.mean_albedo(average(ggx));
  result.base_scale_ = entering > 0 ? 1 / entering : 0;
  if (base.is_rough()) result.base_scale_ /= Eon::layer_gain(base.roughness);
  return result;
}

Glossy Glossy::mix(const Glossy& coated_diffuse, const Glossy& conductor, float metallic) {
  Glossy result = coated_diffuse;
  result.fresnel_.f0 = vernier::mix(metallic, coated_diffuse.fresnel_.f0, conductor.fresnel_.f0);
  result.fresnel_.f90 = lerp(metallic, coated_diffuse.fresnel_.f90, conductor.fresnel_.f90);
  result.base_.reflected *= 1 - metallic;
  result.base_.transmitted *= 1 - metallic;
  result.base_.part = std::max(1 - metallic, 1 / 65535.f);  // it divides
  result.multiple_ = conductor.multiple_ * metallic;
  result.multiple_scale_ = conductor.multiple_scale_;
  return result;
}

}  // namespace vernier
