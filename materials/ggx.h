// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/math.h"

namespace vernier {

/// GGX distribution of microfacet normals with height-correlated Smith masking-shadowing, axes x and y
/// (Walter et al. 2007, "Microfacet Models for Refraction"; Heitz 2014, "Understanding the Masking-Shadowing
/// Function"). Directions in the local frame, n = +z; formulas hold for z > 0.
struct Ggx {
  float ax = 1, ay = 1;  ///< widths; glTF: roughness squared

  /// Below this width the lobe is narrower than a half-vector formed in float can resolve, and counts as a
  /// mirror.
  static constexpr float smooth_limit = 5e-4f;
  bool is_smooth() const { return std::max(ax, ay) < smooth_limit; }
  float mean_width() const { return ax == ay ? ax : std::sqrt(ax * ay); }

  /// Density of facet normals m per unit projected area and solid angle.
  float d(const Vec3f& m) const {
    const float s = square(m.x / ax) + square(m.y / ay) + m.z * m.z;
    return inv_pi / (ax * ay * s * s);
  }

  /// Smith's lambda: masked over visible facet area (Heitz 2014, eq. 86).
  float lambda(const Vec3f& w) const {
    const float t2 = (square(ax * w.x) + square(ay * w.y)) / (w.z * w.z);
    return (std::sqrt(1 + t2) - 1) / 2;
  }
  float g1(const Vec3f& w) const { return 1 / (1 + lambda(w)); }
  /// Both directions on the same side (Heitz 2014, eq. 99).
  float g2(const Vec3f& wo, const Vec3f& wi) const { return 1 / (1 + lambda(wo) + lambda(wi)); }

  /// Density of the visible normals m from wo, per solid angle of m (Heitz 2014, eq. 16).
  float visible_pdf(const Vec3f& wo, const Vec3f& m) const {
    return g1(wo) * std::max(0.f, dot(wo, m)) * d(m) / wo.z;
  }

  /// A normal visible from wo, density visible_pdf (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals
  /// with Spherical Caps", listing 3).
  Vec3f sample_visible(const Vec3f& wo, const Vec2f& u) const {
    const Vec3f stretched = normalize(Vec3f(wo.x * ax, wo.y * ay, wo.z));
    const float phi = 2 * pi * u.x;
    const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
    const float r = safe_sqrt(1 - z * z);
    const Vec3f half = Vec3f(r * std::cos(phi), r * std::sin(phi), z) + stretched;
    return normalize(Vec3f(half.x * ax, half.y * ay, std::max(half.z, 1e-9f)));
  }
};

}  // namespace vernier
