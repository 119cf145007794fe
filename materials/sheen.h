// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/bsdf_sample.h"

namespace vernier {

/// Fibres standing on a surface, glTF's sheen layer: "Charlie" distribution with its fitted masking (Conty
/// Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF", eqs. 2 and 3). Narrow distributions
/// return up to four times the light they get at grazing angles; where that happens the lobe is scaled down,
/// the same from both directions.
class Sheen {
 public:
  static constexpr float least_roughness = 0.05f;

  Sheen() = default;  ///< none
  /// roughness in [0, 1]; below least_roughness, where nothing is left to see but within a degree of
  /// the horizon, taken for that.
  Sheen(const Rgb& color, float roughness)
      : color_(color), roughness_(std::max(roughness, least_roughness)) {}

  explicit operator bool() const { return !is_black(color_); }

  /// f cos of the fibres.
  Rgb f_cos(const Vec3f& wo, const Vec3f& wi) const;
  /// Fraction of light that the fibres return.
  Rgb albedo(float cos_theta) const { return color_ * returned(cos_theta); }
  /// What the layer below keeps of its own f: the lesser of what both directions let through (glTF
  /// KHR_materials_sheen, albedo scaling).
  float base_scale(const Vec3f& wo, const Vec3f& wi) const;
  /// The same for all directions to the base, as far as wo tells.
  float base_scale(float cos_theta) const { return 1 - max_component(color_) * returned(cos_theta); }

 private:
  /// Fraction returned by white fibres, after scaling down.
  float returned(float cos_theta) const;

  Rgb color_{0, 0, 0};
  float roughness_ = 1;
};

/// Directional albedo of white sheen before scaling down, from a table integrated at first use (some 100 ms
/// on one core): not below the integral, and within 1 % above it where it is more than 0.01.
float charlie_albedo(float cos_theta, float roughness);

}  // namespace vernier
