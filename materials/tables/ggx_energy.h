// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/ggx.h"

namespace vernier {

/// How much of the light a GGX reflection lobe returns after one bounce on its facets, split so that any
/// Schlick reflectance follows: f0 (1 - energy_loss - schlick_bias) + f90 schlick_bias (Karis 2013, "Real
/// Shading in Unreal Engine 4", environment BRDF). With reflectance 1 it is 1 - energy_loss.
struct GgxAlbedo {
  float energy_loss = 0;  ///< blocked by other facets
  float schlick_bias = 0;

  Rgb with(const Rgb& f0, const Rgb& f90) const {
    return f0 * (1 - energy_loss - schlick_bias) + f90 * schlick_bias;
  }
};

/// Directional albedo at cos_theta in [0,1] for width alpha in [0,1], from a table integrated at first use
/// (some 20 ms on one core); within 7e-4 of the integral for alpha from Ggx::smooth_limit upwards.
GgxAlbedo ggx_albedo(float cos_theta, float alpha);

/// Cosine-weighted mean of ggx_albedo() over the hemisphere: of what the table says, so that a lobe built
/// from both loses nothing to interpolation.
GgxAlbedo ggx_average_albedo(float alpha);

/// The same for lobes that may be anisotropic, toward w.
GgxAlbedo ggx_albedo(const Vec3f& w, const Ggx& ggx);
GgxAlbedo ggx_average_albedo(const Ggx& ggx);

}  // namespace vernier
