#pragma once

#include "integrators/integrator.h"
#include "materials/material.h"

// Small pieces that more than one integrator needs.

namespace vernier {

/// Weight of a sample drawn with density `pdf` where another technique could have drawn it with `other_pdf`
/// (Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", eq. 9.13 with exponent 2).
inline float power_heuristic(float pdf, float other_pdf) {
  const float ratio = other_pdf / pdf;
  return 1 / (1 + ratio * ratio);
}

/// Beer-Lambert: what is left of light after `distance` metres, which may be infinite, at `absorption` per
/// metre.
inline Rgb transmittance(const Rgb& absorption, float distance) {
  if (is_black(absorption)) return {1, 1, 1};
  Rgb left;
  for (int c = 0; c < 3; ++c) left[c] = absorption[c] > 0 ? std::exp(-absorption[c] * distance) : 1;
  return left;
}

/// Absorption on the far side of a surface crossed from its front or back. A thin surface has none behind it.
inline Rgb absorption_beyond(const Material& material, bool entering) {
  return entering && material.is_volume_boundary() ? material.absorption() : Rgb(0, 0, 0);
}

}  // namespace vernier
