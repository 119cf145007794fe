#pragma once

#include "core/math/vec.h"

namespace vernier {

/// Unpolarised reflectance of a smooth boundary, cos_i = |cos| of the incident direction >= 0, eta = index of the
/// far side over that of the near side. 1 under total internal reflection. `cos_t` receives the cosine of the
/// refracted direction (0 under total internal reflection).
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

}  // namespace vernier
