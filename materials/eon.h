// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/frame.h"
#include "vernier/math.h"

namespace vernier {

/// A number in [0, 1] in sixteen bits; 0 and 1 are exact.
class Unit16 {
 public:
  Unit16(float value) : code_(uint16_t(std::lround(std::clamp(value, 0.f, 1.f) * 65535))) {}
  operator float() const { return float(code_) / 65535; }
  bool is_zero() const { return code_ == 0; }

 private:
  uint16_t code_;
};

/// Diffuse reflection by a rough surface, one of V-shaped cavities whose sides are Lambertian, which loses no
/// energy: EON (Portsmouth, Kutz and Hill 2025, "EON: A practical energy-preserving rough diffuse BRDF",
/// JCGT 14 (1)). Light that leaves a cavity after one event follows Fujii's form of Oren and Nayar's model
/// (listing 1, "FON"); what that loses comes back after further events as a lobe of Kulla and Conty's kind.
/// Written here so that a roughness of 0 divides nothing by nothing: with G the paper's integral, all that
/// FON loses is proportional to the roughness and to `loss` = 1/2 - 2 / (3 pi) - G / pi.
class Eon {
 public:
  /// roughness in [0, 1]: 1 stands for a standard deviation of the cavities' slopes of pi / 2.
  explicit Eon(float roughness) : roughness_(roughness), scale_(1 / (1 + whole_loss * roughness)) {}

  /// pi times the BRDF of a surface whose sides reflect `color`; wi and wo above it.
  Rgb operator()(const Rgb& color, const Vec3f& wo, const Vec3f& wi) const {
    const float s = wo.x * wi.x + wo.y * wi.y;
    const float first = scale_ * (1 + roughness_ * (s > 0 ? s / std::max(wo.z, wi.z) : s));
    const float later = scale_ * roughness_ * loss(wo.z) * loss(wi.z) / mean_loss;
    return color * first + after_more_events(color) * later;
  }

  /// The part of light that leaves for wo, or comes from there, when it comes from, or leaves for, all sides.
  Rgb albedo(const Rgb& color, float cosine) const {
    const float lost = loss(cosine);
    const float first = scale_ * (1 + roughness_ * (whole_loss - lost));
    return color * first + after_more_events(color) * (scale_ * roughness_ * lost);
  }

  /// Drawn in proportion to a mixture of the cosine and of no preference, more of the latter where wo grazes:
  /// there the lobe rises toward wo as 1 / cosine, and cosines alone would leave weights of up to 40.
  Vec3f sample(const Vec3f& wo, const Vec2f& v) const {
    const float p = even_part(wo.z);
    const float cosine = 2 * v.x / (p + std::sqrt(p * p + 4 * (1 - p) * v.x));
    if (!(cosine > 0)) return {1, 0, 0};
    const float sine = safe_sqrt(1 - cosine * cosine), phi = 2 * pi * v.y;
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
  }
  float pdf(const Vec3f& wo, float cos_i) const {
    const float p = even_part(wo.z);
    return (p / 2 + (1 - p) * cos_i) * inv_pi;
  }

  /// The most that a layer with Schlick's reflectance over such a body would multiply its light by, were it
  /// scaled as one over a Lambertian body is: seen from above, rough bodies scatter less toward grazing
  /// directions, where the layer lets less pass. That of a smooth layer, by quadrature; rough ones add less.
  static float layer_gain(float roughness) { return 1 + 0.00867f * roughness / (1 + whole_loss * roughness); }

 private:
  /// 1/2 - 2 / (3 pi), and its mean over directions, weighted by cosine, less that of G / pi.
  static constexpr float whole_loss = 0.28779341f;
  static constexpr float mean_loss = whole_loss - 0.07248821f;

  float even_part(float cos_o) const { return 0.4f * roughness_ * (1 - cos_o) * (1 - cos_o); }

  /// FON loses scale x roughness x this of light toward a direction (the paper's E_FON).
  static float loss(float cosine) {
    const float mu = std::clamp(cosine, 0.f, 1.f), sine = safe_sqrt(1 - mu * mu);
    // (sine / mu) (1 - sine^3), of which 1 - sine = mu^2 / (1 + sine) takes the mu away.
    const float ratio = sine * mu * (1 + sine + sine * sine) / (1 + sine);
    const float g = sine * (std::acos(mu) - sine * mu) + (2 / 3.f) * (ratio - sine);
    return std::max(0.f, whole_loss - g * inv_pi);
  }

  /// Color of light that was reflected more than once. Vertex colors may make a surface brighter than white,
  /// whose series would have no end.
  Rgb after_more_events(const Rgb& color) const {
    const float lost = scale_ * roughness_ * mean_loss;
    Rgb result(0, 0, 0);
    for (int c = 0; c < 3; ++c) {
      const float each = std::min(color[c], 1.f);
      result[c] = color[c] * each * (1 - lost) / (1 - each * lost);
    }
    return result;
  }

  float roughness_, scale_;
};

}  // namespace vernier
