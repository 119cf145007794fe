// SPDX-License-Identifier: Apache-2.0
#include "materials/tables/ggx_energy.h"

#include <array>

#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/tables/albedo_table_mapping.h"
#include "materials/tables/ggx_anisotropy.h"
#include "materials/tables/ggx_integral.h"

namespace vernier {
namespace {

constexpr int cosines = 96;
constexpr int widths = 40;
constexpr int averages = 8 * (widths - 1) + 1;  // every row of the table and seven between

// Widths are even in roughness, from the narrowest that is no mirror.
float least_roughness() { return std::sqrt(Ggx::smooth_limit); }
float width_position(float alpha) { return (std::sqrt(alpha) - least_roughness()) / (1 - least_roughness()); }
float width_at(float position) { return square(lerp(position, least_roughness(), 1)); }

GgxAlbedo mix(float t, const GgxAlbedo& a, const GgxAlbedo& b) {
  return {lerp(t, a.energy_loss, b.energy_loss), lerp(t, a.schlick_bias, b.schlick_bias)};
}

template <size_t N>
GgxAlbedo interpolate(const std::array<GgxAlbedo, N>& nodes, float x) {
  const float position = std::clamp(x, 0.f, 1.f) * float(N - 1);
  const int index = std::min(int(position), int(N) - 2);
  return mix(position - float(index), nodes[index], nodes[index + 1]);
}

struct Table {
  std::array<std::array<GgxAlbedo, cosines>, widths>
      directional;  ///< bias is in excess of a smooth surface's
  std::array<GgxAlbedo, averages> average;

  GgxAlbedo albedo(float cos_theta, float alpha) const {
    const float x = albedo_coordinate(cos_theta, alpha);
    const float row = std::max(0.f, width_position(alpha)) * float(widths - 1);
    const int index = std::min(int(row), widths - 2);
    GgxAlbedo result =
        mix(row - float(index), interpolate(directional[index], x), interpolate(directional[index + 1], x));
    result.schlick_bias += (1 - result.energy_loss) * schlick_weight(cos_theta);
    return result;
  }
};

GgxAlbedo average(const Table& table, float alpha) {
  constexpr int steps = 512;
  double missing = 0, bias = 0;
  for (int s = 0; s < steps; ++s) {
    const float low = albedo_cosine(float(s) / steps, alpha),
                high = albedo_cosine(float(s + 1) / steps, alpha);
    const GgxAlbedo middle = table.albedo((low + high) / 2, alpha);
    const double weight = double(high) * high - double(low) * low;
    missing += weight * middle.energy_loss;
    bias += weight * middle.schlick_bias;
  }
  return {float(missing), float(bias)};
}

/// On one thread: others may wait for it, and a thread that shares work while it holds them up could be given
/// work that needs the table.
Table make_table() {
  Table table;
  for (int j = 0; j < widths; ++j) {
    const float alpha = width_at(float(j) / (widths - 1));
    for (int i = 0; i < cosines; ++i) {
      const float z = std::max({albedo_cosine(float(i) / (cosines - 1), alpha), 1e-5f * alpha, 1e-7f});
      table.directional[j][i] = integrate_ggx_albedo({safe_sqrt(1 - z * z), 0, z}, {alpha, alpha});
    }
  }
  for (int k = 0; k < averages; ++k) table.average[k] = average(table, width_at(float(k) / (averages - 1)));
  return table;
}

const Table& table() {
  static const Table instance = make_table();
  return instance;
}

}  // namespace

GgxAlbedo ggx_albedo(float cos_theta, float alpha) {
  return table().albedo(std::clamp(cos_theta, 0.f, 1.f), std::clamp(alpha, Ggx::smooth_limit, 1.f));
}

GgxAlbedo ggx_average_albedo(float alpha) {
  return interpolate(table().average, width_position(std::clamp(alpha, Ggx::smooth_limit, 1.f)));
}

GgxAlbedo ggx_albedo(const Vec3f& w, const Ggx& ggx) {
  return ggx.ax == ggx.ay ? ggx_albedo(w.z, ggx.ax) : anisotropic_albedo(w, ggx);
}

GgxAlbedo ggx_average_albedo(const Ggx& ggx) {
  return ggx.ax == ggx.ay ? ggx_average_albedo(ggx.ax) : anisotropic_average_albedo(ggx);
}

}  // namespace vernier
