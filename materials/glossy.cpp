// SPDX-License-Identifier: Apache-2.0
#include "materials/glossy.h"

namespace vernier {
namespace {

GgxAlbedo average(const Ggx& ggx) {
  return ggx.is_smooth() ? GgxAlbedo{0, 1 / 21.f} : ggx_average_albedo(ggx);
}

Rgb mix(float t, const Rgb& a, const Rgb& b) { return a * (1 - t) + b * t; }

}  // namespace

Glossy Glossy::metal(const Fresnel& fresnel, const Ggx& ggx) {
  Glossy result(fresnel, ggx);
  const float missing = average(ggx).missing;
  if (missing <= 0) return result;
  // Each further bounce is reflected by the mean Fresnel reflectance (Kulla and Conty 2017).
  const Rgb f = fresnel.mean();
  for (int c = 0; c < 3; ++c) result.multiple_[c] = f[c] * f[c] * (1 - missing) / (1 - f[c] * missing);
  result.multiple_scale_ = 1 / missing;
  return result;
}

Glossy Glossy::plastic(const Fresnel& fresnel, const Ggx& ggx, const DiffuseBody& body) {
  Glossy result(fresnel, ggx);
  result.body_ = body;
  result.bound_ = fresnel.bound();
  const float entering = 1 - result.bound_.mean_albedo(average(ggx));
  result.body_scale_ = entering > 0 ? 1 / entering : 0;
  return result;
}

Glossy Glossy::mix(const Glossy& plastic, const Glossy& metal, float metallic) {
  Glossy result = plastic;
  result.fresnel_.f0 = vernier::mix(metallic, plastic.fresnel_.f0, metal.fresnel_.f0);
  result.fresnel_.f90 = lerp(metallic, plastic.fresnel_.f90, metal.fresnel_.f90);
  result.body_.reflected *= 1 - metallic;
  result.body_.transmitted *= 1 - metallic;
  result.multiple_ = metal.multiple_ * metallic;
  result.multiple_scale_ = metal.multiple_scale_;
  return result;
}

}  // namespace vernier
