// SPDX-License-Identifier: Apache-2.0
#include "materials/tables/ggx_anisotropy.h"

#include <array>
#include <mutex>

#include "materials/fresnel.h"
#include "materials/tables/albedo_table_mapping.h"
#include "materials/tables/ggx_integral.h"

namespace vernier {
namespace {

constexpr int widths = 24, cosines = 48, azimuths = 13;

/// Widths of tables, even in roughness from the narrowest that is no mirror.
float width_at(int index) {
  const float least = std::sqrt(Ggx::smooth_limit);
  return square(lerp(float(index) / (widths - 1), least, 1));
}

/// Width of the slice through the lobe at an azimuth.
float slice_width(const Ggx& ggx, float cos_phi, float sin_phi) {
  return std::sqrt(square(ggx.ax * cos_phi) + square(ggx.ay * sin_phi));
}

GgxAlbedo mix(float t, const GgxAlbedo& a, const GgxAlbedo& b) {
  return {lerp(t, a.energy_loss, b.energy_loss), lerp(t, a.schlick_bias, b.schlick_bias)};
}

/// Where a number falls between nodes.
struct Place {
  int index;
  float fraction;
};

Place place(float x, int nodes) {
  const float position = std::clamp(x, 0.f, 1.f) * float(nodes - 1);
  const int index = std::min(int(position), nodes - 2);
  return {index, position - float(index)};
}

/// Between two widths what is missing grows with their square, away from grazing.
Place place_width(float alpha) {
  const float a = std::clamp(alpha, Ggx::smooth_limit, 1.f);
  const float least = std::sqrt(Ggx::smooth_limit);
  const int index = place((std::sqrt(a) - least) / (1 - least), widths).index;
  const float low = square(width_at(index)), high = square(width_at(index + 1));
  return {index, (a * a - low) / (high - low)};
}

/// Albedos of one pair of widths; `schlick_bias` is in excess of a smooth surface's. Azimuths of the first
/// quarter, which the others mirror.
class PairTable {
 public:
  /// `coordinate`: albedo_coordinate() of the cosine and the width of the slice at `azimuth`.
  GgxAlbedo at(float coordinate, float azimuth) const {
    const auto [j, v] = place(azimuth / (pi / 2), azimuths);
    const auto [i, u] = place(coordinate, cosines);
    return mix(v, mix(u, nodes_[j][i], nodes_[j][i + 1]), mix(u, nodes_[j + 1][i], nodes_[j + 1][i + 1]));
  }
  const GgxAlbedo& average() const { return average_; }

  const PairTable& integrated(const Ggx& ggx) {
    std::call_once(once_, [&] { integrate(ggx); });
    return *this;
  }

 private:
  void integrate(const Ggx& ggx) {
    double missing = 0, bias = 0;
    for (int j = 0; j < azimuths; ++j) {
      const float phi = (pi / 2) * float(j) / (azimuths - 1), c = std::cos(phi), s = std::sin(phi);
      const float alpha = slice_width(ggx, c, s);
      for (int i = 0; i < cosines; ++i) {
        const float z = std::max({albedo_cosine(float(i) / (cosines - 1), alpha), 1e-5f * alpha, 1e-7f});
        const float sine = safe_sqrt(1 - z * z);
        nodes_[j][i] = integrate_ggx_albedo({sine * c, sine * s, z}, ggx);
      }
      // The trapezoid rule over azimuths is exact for what lookups interpolate.
      const double weight = (j == 0 || j == azimuths - 1 ? 0.5 : 1) / (azimuths - 1);
      constexpr int steps = 512;
      for (int k = 0; k < steps; ++k) {
        const float low = albedo_cosine(float(k) / steps, alpha),
                    high = albedo_cosine(float(k + 1) / steps, alpha);
        const float z = (low + high) / 2;
        const auto [i, u] = place(albedo_coordinate(z, alpha), cosines);
        const GgxAlbedo middle = mix(u, nodes_[j][i], nodes_[j][i + 1]);
        const double area = weight * (double(high) * high - double(low) * low);
        missing += area * middle.energy_loss;
        bias += area * (middle.schlick_bias + (1 - middle.energy_loss) * schlick_weight(z));
      }
    }
    average_ = {float(missing), float(bias)};
  }

  std::once_flag once_;
  std::array<std::array<GgxAlbedo, cosines>, azimuths> nodes_;
  GgxAlbedo average_;
};

/// The table of the widths at nodes i and j, i >= j.
const PairTable& pair_table(int i, int j) {
  static std::array<PairTable, widths*(widths + 1) / 2> tables;
  const size_t index = size_t(i) * size_t(i + 1) / 2 + size_t(j);
  return tables[index].integrated({width_at(i), width_at(j)});
}

/// Bilinear over the four tables about a pair of widths; read(i, j) takes node indices of ax and ay.
template <typename Read>
GgxAlbedo over_widths(const Ggx& ggx, const Read& read) {
  const auto [i, u] = place_width(ggx.ax);
  const auto [j, v] = place_width(ggx.ay);
  return mix(v, mix(u, read(i, j), read(i + 1, j)), mix(u, read(i, j + 1), read(i + 1, j + 1)));
}

}  // namespace

GgxAlbedo anisotropic_albedo(const Vec3f& w, const Ggx& ggx) {
  const float sine = std::sqrt(w.x * w.x + w.y * w.y);
  const float c = sine > 0 ? std::abs(w.x) / sine : 1, s = sine > 0 ? std::abs(w.y) / sine : 0;
  const float azimuth = std::atan2(s, c);
  const float x = albedo_coordinate(std::clamp(w.z, 0.f, 1.f), slice_width(ggx, c, s));
  GgxAlbedo result = over_widths(ggx, [&](int i, int j) {
    return i >= j ? pair_table(i, j).at(x, azimuth) : pair_table(j, i).at(x, pi / 2 - azimuth);
  });
  result.schlick_bias += (1 - result.energy_loss) * schlick_weight(w.z);
  return result;
}

GgxAlbedo anisotropic_average_albedo(const Ggx& ggx) {
  return over_widths(ggx, [](int i, int j) { return pair_table(std::max(i, j), std::min(i, j)).average(); });
}

}  // namespace vernier
