// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/tables/ggx_energy.h"
#include "materials/thin_film.h"

namespace vernier {

/// Unpolarised reflectance of a smooth boundary, cos_i = |cos| of the incident direction >= 0, eta = index of
/// the far side over that of the near side. 1 under total internal reflection. `cos_t` receives the cosine of
/// the refracted direction (0 under total internal reflection).
inline float fresnel_dielectric(float cos_i, float eta, float& cos_t) {
  const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  if (sin2_t >= 1) {
    cos_t = 0;
    return 1;
  }
  cos_t = std::sqrt(1 - sin2_t);
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return (parallel * parallel + perpendicular * perpendicular) / 2;
}

/// (1 - cos)^5, the weight of the grazing reflectance in Schlick's approximation
/// (Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 24).
inline float schlick_weight(float cos_theta) {
  const float m = std::clamp(1 - cos_theta, 0.f, 1.f);
  return m * m * m * m * m;
}

/// Schlick's reflectance between f0 at normal and f90 at grazing incidence.
inline Rgb fresnel_schlick(const Rgb& f0, const Rgb& f90, float cos_theta) {
  return f0 + (f90 - f0) * schlick_weight(cos_theta);
}

/// Reflectance at normal incidence of a boundary with relative index eta.
inline float f0_from_ior(float eta) { return square((eta - 1) / (eta + 1)); }

/// Schlick's curve of one channel, or a curve that no channel exceeds:
/// f0 + (f90 - f0) x^5 + quartic (x^4 - x^5), x = 1 - cos.
struct SchlickCurve {
  float f0 = 0, f90 = 1;
  float quartic = 0;  ///< thin films come to reflect everything sooner toward grazing

  /// Share of light that a GGX surface of this reflectance returns; with a quartic an upper bound, by
  /// Jensen's inequality for the mean of the concave function x^4 of x^5.
  float albedo(const GgxAlbedo& ggx) const {
    return linear_part(ggx) + quartic * (quartic_part(ggx, 1) - ggx.schlick_bias);
  }
  /// The same from the mean over the hemisphere, where x^5 is 1/21 and x^4 1/15 for a smooth surface.
  float mean_albedo(const GgxAlbedo& ggx) const {
    return linear_part(ggx) + quartic * (quartic_part(ggx, 21) / 15 - ggx.schlick_bias);
  }

 private:
  float linear_part(const GgxAlbedo& ggx) const {
    return f0 * (1 - ggx.energy_loss - ggx.schlick_bias) + f90 * ggx.schlick_bias;
  }
  float quartic_part(const GgxAlbedo& ggx, float scale) const {
    if (quartic == 0) return 0;
    const float facets = 1 - ggx.energy_loss;
    return facets * std::pow(scale * ggx.schlick_bias / facets, 0.8f);
  }
};

/// How much of the light a facet reflects: Schlick's curve, through a thin film where there is one.
struct Fresnel {
  Rgb f0{0.04f, 0.04f, 0.04f};
  float f90 = 1;
  ThinFilm film;

  Rgb operator()(float cos_theta) const {
    const Rgb bare = fresnel_schlick(f0, Rgb(f90), cos_theta);
    if (!film) return bare;
    return bare * (1 - film.strength) + film.reflectance(f0, cos_theta) * film.strength;
  }

  /// The same between f0 and f90 along an exact curve, of which `exact` is the value and exact_f0 that at
  /// normal incidence. cos_theta on the side of the air, for the film.
  Rgb along(float exact, float exact_f0, float cos_theta) const {
    const float grazing =
        exact_f0 < 0.999f ? std::max((exact - exact_f0) / (1 - exact_f0), 0.f) : schlick_weight(cos_theta);
    const Rgb bare = f0 + (Rgb(f90) - f0) * grazing;
    return film ? bare * (1 - film.strength) + film.reflectance(f0, cos_theta) * film.strength : bare;
  }

  /// Of a GGX surface seen at cos_theta. Exact without film; with one, as if all facets reflected as the
  /// surface does.
  Rgb albedo(const GgxAlbedo& ggx, float cos_theta) const {
    return film ? (*this)(cos_theta) * (1 - ggx.energy_loss) : ggx.with(f0, Rgb(f90));
  }

  /// Cosine-weighted mean over the hemisphere; Schlick's is f0 + (f90 - f0) / 21.
  Rgb mean() const;

  /// A curve that no channel exceeds; without film the largest channel itself.
  SchlickCurve bound() const;
};

}  // namespace vernier
