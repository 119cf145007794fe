// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/frame.h"
#include "materials/glossy.h"

namespace vernier {

/// Clear varnish of index 1.5 (glTF KHR_materials_clearcoat): GGX facets that reflect `weight` F(n.wo) of the
/// light, F by Schlick, and leave the rest to what lies below. That both are weighed by the angle of wo alone
/// is the extension's own choice; it conserves energy but is not reciprocal. Light that facets block of each
/// other is given back as a white metal does, so the coat loses none.
struct Clearcoat {
  float weight = 0;       ///< 0: none
  float alpha = 0;        ///< width of its facets: roughness squared
  Vec3f normal{0, 0, 1};  ///< in the frame of the layer below

  explicit operator bool() const { return weight > 0; }

  /// Fraction of light it reflects when met at this angle.
  float reflectance(float cos_theta) const { return weight * lerp(schlick_weight(cos_theta), 0.04f, 1.f); }

  /// Frame of the coat; that of the layer below where the coat's normal faces away from wo.
  Frame frame(const Vec3f& wo) const {
    return Frame::from_normal(dot(wo, normal) > 1e-3f ? normal : Vec3f(0, 0, 1));
  }

  /// Its facets in that frame, reflecting everything.
  Glossy facets() const { return Glossy::conductor({{1, 1, 1}, 1, {}}, {alpha, alpha}); }
};

}  // namespace vernier
