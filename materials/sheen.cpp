// SPDX-License-Identifier: Apache-2.0
#include "materials/sheen.h"

#include <vector>

#include "materials/tables/gauss_nodes.h"

namespace vernier {
namespace {

constexpr float least_roughness = Sheen::least_roughness;
/// Smith's lambda grows without bound toward grazing; its fit stops being one below this.
constexpr float least_cosine = 1e-4f;

/// Charlie's distribution and masking for one width alpha.
class Charlie {
 public:
  explicit Charlie(float alpha) : inverse_(1 / alpha), t_(square(1 - alpha)), half_(fit(0.5f)) {}

  /// D G / (4 cos cos), cosines toward the normal; cos_m: of the half vector.
  float f(float cos_o, float cos_i, float cos_m) const {
    const float o = std::max(cos_o, least_cosine), i = std::max(cos_i, least_cosine);
    const float sin2 = std::max(0.f, 1 - cos_m * cos_m);
    const float d = (2 + inverse_) * std::pow(sin2, inverse_ / 2) * (inv_pi / 2);
    return d / ((1 + lambda(o) + lambda(i)) * 4 * o * i);
  }

 private:
  float fit(float x) const {
    const float a = lerp(t_, 21.5473f, 25.3245f), b = lerp(t_, 3.82987f, 3.32435f);
    const float c = lerp(t_, 0.19823f, 0.16801f), d = lerp(t_, -1.97760f, -1.27393f);
    const float e = lerp(t_, -4.32054f, -4.85967f);
    return a / (1 + b * std::pow(x, c)) + d * x + e;
  }
  float lambda(float cosine) const {
    return cosine < 0.5f ? std::exp(fit(cosine)) : std::exp(2 * half_ - fit(std::max(1 - cosine, 0.f)));
  }

  float inverse_, t_, half_;
};

float integrate(float cos_theta, float roughness) {
  const Charlie charlie(square(roughness));
  const float o = std::max(cos_theta, least_cosine), sin_o = safe_sqrt(1 - o * o);
  double sum = 0;
  for_each_gauss_node<24>([&](float x, float wx) {
    const float cos_i = x * x, sin_i = safe_sqrt(1 - cos_i * cos_i);  // denser toward grazing
    for_each_gauss_node<24>([&](float y, float wy) {
      const float phi = pi * y;
      const Vec3f m = normalize(Vec3f(sin_o + sin_i * std::cos(phi), sin_i * std::sin(phi), o + cos_i));
      sum += double(wx * 2 * x) * (wy * 2 * pi) * charlie.f(o, cos_i, m.z) * cos_i;
    });
  });
  return float(sum);
}

/// Nodes are dense where the sheen of narrow distributions is: at cosines about the roughness, and at small
/// roughness.
class Table {
 public:
  Table() : nodes_(size_t(cosines) * widths) {
    for (int j = 0; j < widths; ++j) {
      const float roughness = lerp(std::pow(float(j) / (widths - 1), 1.5f), least_roughness, 1.f);
      for (int i = 0; i < cosines; ++i) {
        const float s = float(i) / (cosines - 1), cubed = s * s * s;
        const float cosine = roughness * cubed / (1 + roughness - cubed);
        nodes_[size_t(j) * cosines + size_t(i)] = margin * integrate(cosine, roughness);
      }
    }
  }

  float at(float cosine, float roughness) const {
    const float s = std::cbrt(cosine * (1 + roughness) / (cosine + roughness));
    const float r = std::max(roughness - least_roughness, 0.f) / (1 - least_roughness);
    const float x = s * (cosines - 1), y = std::cbrt(r * r) * (widths - 1);
    const int i = std::min(int(x), cosines - 2), j = std::min(int(y), widths - 2);
    const float* low = &nodes_[size_t(j) * cosines + size_t(i)];
    const float* high = low + cosines;
    return lerp(y - float(j), lerp(x - float(i), low[0], low[1]), lerp(x - float(i), high[0], high[1]));
  }

 private:
  static constexpr int cosines = 64, widths = 32;
  /// Covers what interpolation between nodes falls short of the integral, so that no layer gives back too
  /// much.
  static constexpr float margin = 1.005f;

  std::vector<float> nodes_;
};

}  // namespace

float charlie_albedo(float cos_theta, float roughness) {
  static const Table table;
  return table.at(std::clamp(cos_theta, 0.f, 1.f), std::clamp(roughness, least_roughness, 1.f));
}

float Sheen::returned(float cos_theta) const { return std::min(charlie_albedo(cos_theta, roughness_), 1.f); }

Rgb Sheen::f_cos(const Vec3f& wo, const Vec3f& wi) const {
  if (wi.z <= 0) return {0, 0, 0};
  const Vec3f m = normalize(wo + wi);
  const float excess = std::max({charlie_albedo(wo.z, roughness_), charlie_albedo(wi.z, roughness_), 1.f});
  return color_ * (Charlie(square(roughness_)).f(wo.z, wi.z, m.z) * wi.z / excess);
}

float Sheen::base_scale(const Vec3f& wo, const Vec3f& wi) const {
  return std::min(base_scale(wo.z), base_scale(std::abs(wi.z)));
}

}  // namespace vernier
