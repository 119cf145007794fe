// SPDX-License-Identifier: Apache-2.0
#include "materials/fresnel.h"

namespace vernier {

Rgb Fresnel::mean() const {
  if (!film) return f0 + (Rgb(f90) - f0) / 21;
  // Midpoints of equal parts of cos^2, the measure of the mean.
  constexpr int steps = 4;
  Rgb sum(0, 0, 0);
  for (int i = 0; i < steps; ++i) sum += (*this)(std::sqrt((float(i) + 0.5f) / steps));
  return sum / steps;
}

SchlickCurve Fresnel::bound() const {
  if (!film) return {max_component(f0), f90};
  // The film's own reflectance is 1 at grazing incidence whatever the base.
  SchlickCurve curve{0, lerp(film.strength, f90, 1), 0};
  const auto excess = [&](float cosine) {
    const float grazing = schlick_weight(cosine);
    return max_component((*this)(cosine)) - lerp(grazing, curve.f0, curve.f90);
  };
  for (const float cosine : {1.f, 0.95f, 0.9f, 0.83f, 0.75f, 0.65f, 0.55f})
    curve.f0 += std::max(excess(cosine), 0.f) / (1 - schlick_weight(cosine));
  for (const float cosine : {0.45f, 0.35f, 0.25f, 0.15f, 0.07f, 0.02f})
    curve.quartic = std::max(curve.quartic, excess(cosine) / (cosine * square(square(1 - cosine))));
  return curve;
}

}  // namespace vernier
