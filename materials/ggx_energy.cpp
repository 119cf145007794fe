#include "materials/ggx_energy.h"

#include <array>

#include "materials/fresnel.h"
#include "materials/gauss_nodes.h"
#include "materials/ggx.h"
#include "materials/ggx_coordinates.h"

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
  return {lerp(t, a.missing, b.missing), lerp(t, a.bias, b.bias)};
}

template <size_t N>
GgxAlbedo interpolate(const std::array<GgxAlbedo, N>& nodes, float x) {
  const float position = std::clamp(x, 0.f, 1.f) * float(N - 1);
  const int index = std::min(int(position), int(N) - 2);
  return mix(position - float(index), nodes[index], nodes[index + 1]);
}

/// Integral over facet normals of G2 D (o.m) / o.z, alone and times what the grazing reflectance exceeds that
/// of a smooth surface by; tables keep that excess as `bias`, because it bends little. Normals are taken in
/// polar angles, each azimuth up to where the reflected direction meets the horizon, so that the integrand is
/// smooth; the angle is stretched by 1/alpha, and azimuths are dense where the horizon moves fastest.
GgxAlbedo integrate(float cos_theta, float alpha) {
  const float z = std::max({cos_theta, 1e-5f * alpha, 1e-7f});
  const float sine = safe_sqrt(1 - z * z);
  const Vec3f wo(sine, 0, z);
  const Ggx ggx{alpha, alpha};
  const float lambda_o = ggx.lambda(wo), smooth = schlick_weight(z);
  double total = 0, excess = 0;
  const auto add_azimuth = [&](float cos_phi, float sin_phi, double weight) {
    const float horizon = (pi / 2 + std::atan2(sine * cos_phi, z)) / 2;
    const float range = std::atan(std::tan(horizon) / alpha);
    for_each_gauss_node<10>([&](float x, float w) {
      const float stretched = range * (1 - (1 - x) * (1 - x) * (1 - x));
      const float sin_s = std::sin(stretched), cos_s = std::cos(stretched);
      const float tan_m = alpha * sin_s / cos_s;
      const float cos_m = 1 / std::sqrt(1 + tan_m * tan_m), sin_m = tan_m * cos_m;
      const Vec3f m(sin_m * cos_phi, sin_m * sin_phi, cos_m);
      const float cos_om = dot(wo, m);
      const Vec3f wi = 2 * cos_om * m - wo;
      if (cos_om <= 0 || wi.z <= 0) return;
      const float density = 6 * range * (1 - x) * (1 - x) * sin_s * cos_s;
      const double value = weight * w * density * cos_om / (z * cos_m * (1 + lambda_o + ggx.lambda(wi)));
      total += value;
      excess += value * (schlick_weight(cos_om) - smooth);
    });
  };
  for_each_gauss_node<7>([&](float x, float w) {
    const float offset = (pi / 2) * x * x;  // of the azimuth from a right angle
    add_azimuth(std::sin(offset), std::cos(offset), w * x);
    add_azimuth(-std::sin(offset), std::cos(offset), w * x);
  });
  return {float(1 - total), float(excess)};
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
    result.bias += (1 - result.missing) * schlick_weight(cos_theta);
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
    missing += weight * middle.missing;
    bias += weight * middle.bias;
  }
  return {float(missing), float(bias)};
}

/// On one thread: others may wait for it, and a thread that shares work while it holds them up could be given
/// work that needs the table.
Table make_table() {
  Table table;
  for (int j = 0; j < widths; ++j) {
    const float alpha = width_at(float(j) / (widths - 1));
    for (int i = 0; i < cosines; ++i)
      table.directional[j][i] = integrate(albedo_cosine(float(i) / (cosines - 1), alpha), alpha);
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

}  // namespace vernier
