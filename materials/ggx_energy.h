#pragma once

#include "core/math/vec.h"

namespace vernier {

/// How much of the light a GGX reflection lobe returns after one bounce on its facets, split so that any Schlick
/// reflectance follows: f0 * scale + f90 * bias (Karis 2013, "Real Shading in Unreal Engine 4", environment BRDF).
/// With reflectance 1 it is scale + bias.
struct GgxAlbedo {
  float scale = 1, bias = 0;

  float total() const { return scale + bias; }
  Rgb with(const Rgb& f0, const Rgb& f90) const { return f0 * scale + f90 * bias; }
};

/// Directional albedo at cos_theta in [0,1] for width alpha in [0,1], from a table integrated at first use; within 5e-4
/// of the integral for alpha >= 0.002.
GgxAlbedo ggx_albedo(float cos_theta, float alpha);

/// Its cosine-weighted mean over the hemisphere.
GgxAlbedo ggx_average_albedo(float alpha);

}  // namespace vernier
