// SPDX-License-Identifier: Apache-2.0
#include "materials/thin_film.h"

#include "materials/fresnel.h"

namespace vernier {
namespace {

/// One Gaussian of the CIE colour matching functions' fit in the Fourier domain (Belcour and Barla 2017,
/// section 4): value, position and variance in SI units of the wave number.
struct Gaussian {
  float value, position, variance;

  /// Share of an oscillation with this path difference (metres) and phase.
  float at(float path, float phase) const {
    const float k = 2 * pi * path;
    return value * std::sqrt(2 * pi * variance) * std::cos(position * k + phase) *
           std::exp(-k * k * variance);
  }
};

constexpr Gaussian x_long{5.4856e-13f, 1.6810e6f, 4.3278e9f}, x_short{9.7470e-14f, 2.2399e6f, 4.5282e9f};
constexpr Gaussian y_bar{4.4201e-13f, 1.7953e6f, 9.3046e9f}, z_bar{5.2481e-13f, 2.2084e6f, 6.6121e9f};
constexpr float normalization = 1.0685e-7f;

/// Rec.709 colour of an oscillation over wavelengths; the phase belongs to a colour channel of the base.
Rgb oscillation(float path, const Rgb& phase) {
  const float x = (x_long.at(path, phase.x) + x_short.at(path, phase.x)) / normalization;
  const float y = y_bar.at(path, phase.y) / normalization;
  const float z = z_bar.at(path, phase.z) / normalization;
  return {3.2404542f * x - 1.5371385f * y - 0.4985314f * z, -0.9692660f * x + 1.8760108f * y + 0.0415560f * z,
          0.0556434f * x - 0.2040259f * y + 1.0572252f * z};
}

/// Index of a clear base with this reflectance in air.
float ior_from_f0(float f0) {
  const float root = std::sqrt(std::min(f0 + 1e-4f, 0.9999f));
  return (1 + root) / (1 - root);
}

float schlick(float f0, float cos_theta) { return f0 + (1 - f0) * schlick_weight(cos_theta); }

}  // namespace

Rgb ThinFilm::reflectance(const Rgb& f0, float cos_theta) const {
  const float cos2_film = 1 - (1 - cos_theta * cos_theta) / (ior * ior);
  if (cos2_film < 0) return {1, 1, 1};
  const float cos_film = std::sqrt(cos2_film);

  const float outer = schlick(f0_from_ior(ior), cos_theta), passed = 1 - outer;
  Rgb sum, amplitude, ratio, phase;
  for (int c = 0; c < 3; ++c) {
    const float base_ior = ior_from_f0(f0[c]);
    const float inner = schlick(f0_from_ior(base_ior / ior), cos_film);
    // Light is turned by half a wave where it is reflected by the denser side.
    phase[c] = (ior < 1 ? 0 : pi) + (base_ior < ior ? pi : 0);
    const float both = std::clamp(outer * inner, 1e-5f, 0.9999f);
    const float trapped = passed * passed * inner / (1 - both);
    sum[c] = outer + trapped;
    amplitude[c] = trapped - passed;
    ratio[c] = std::sqrt(both);
  }
  // Two orders of interference; higher ones are washed out within the width of the colour matching functions.
  const float path = 2 * ior * thickness * cos_film * 1e-9f;
  for (int order = 1; order <= 2; ++order) {
    amplitude *= ratio;
    sum += 2.f * amplitude * oscillation(float(order) * path, float(order) * phase);
  }
  for (int c = 0; c < 3; ++c) sum[c] = std::clamp(sum[c], 0.f, 1.f);
  return sum;
}

}  // namespace vernier
