#include "materials/ggx_energy.h"

#include <array>

#include "core/base/parallel.h"
#include "materials/fresnel.h"
#include "materials/ggx.h"

namespace vernier {
namespace {

// Nodes are denser where the albedo bends most: cosines as squares, so that grazing angles are resolved, and widths
// as squares of roughness.
constexpr int cosines = 48;
constexpr int widths = 32;
constexpr float node_cosine(int i) { return square(float(i) / (cosines - 1)); }
constexpr float node_alpha(int j) { return square(float(j) / (widths - 1)); }

struct Table {
  std::array<std::array<GgxAlbedo, cosines>, widths> directional;
  std::array<GgxAlbedo, widths> average;
};

/// Mean of G2/G1 over visible normals on a midpoint grid: the lobe's albedo, since the rest of f cos / pdf cancels
/// (Heitz 2018, "Sampling the GGX Distribution of Visible Normals", eq. 19).
GgxAlbedo integrate(float cos_theta, float alpha) {
  constexpr int grid = 48;
  const Ggx ggx{std::max(alpha, 1e-4f), std::max(alpha, 1e-4f)};
  const float z = std::max(cos_theta, 1e-4f);
  const Vec3f wo(safe_sqrt(1 - z * z), 0, z);
  double scale = 0, bias = 0;
  for (int i = 0; i < grid; ++i)
    for (int j = 0; j < grid; ++j) {
      const Vec3f m = ggx.sample_visible(wo, {(float(i) + 0.5f) / grid, (float(j) + 0.5f) / grid});
      const float cos_om = dot(wo, m);
      const Vec3f wi = 2 * cos_om * m - wo;
      if (wi.z <= 0) continue;
      const float weight = ggx.g2(wo, wi) / ggx.g1(wo);
      const float grazing = schlick_weight(cos_om);
      scale += weight * (1 - grazing);
      bias += weight * grazing;
    }
  return {float(scale / (grid * grid)), float(bias / (grid * grid))};
}

Table make_table() {
  Table table;
  parallel_for(widths, [&](size_t j) {
    for (int i = 0; i < cosines; ++i) table.directional[j][i] = integrate(node_cosine(i), node_alpha(int(j)));
    // Average of the interpolant that lookups see, so that compensation closes exactly on it:
    // 2 int E(mu) mu dmu with mu = x^2 and E linear in x between nodes, by the midpoint rule in x.
    double scale = 0, bias = 0, weight = 0;
    constexpr int steps = (cosines - 1) * 8;
    for (int s = 0; s < steps; ++s) {
      const double x = (s + 0.5) / steps;
      const int i = std::min(int(x * (cosines - 1)), cosines - 2);
      const double t = x * (cosines - 1) - i;
      const auto& a = table.directional[j][i];
      const auto& b = table.directional[j][i + 1];
      const double w = x * x * x;  // mu dmu = 2 x^3 dx
      scale += w * ((1 - t) * a.scale + t * b.scale);
      bias += w * ((1 - t) * a.bias + t * b.bias);
      weight += w;
    }
    table.average[j] = {float(scale / weight), float(bias / weight)};
  });
  return table;
}

const Table& table() {
  static const Table instance = make_table();
  return instance;
}

struct Position {
  int index;
  float fraction;
};
Position locate(float value, int nodes) {
  const float x = std::sqrt(std::clamp(value, 0.f, 1.f)) * float(nodes - 1);
  const int index = std::min(int(x), nodes - 2);
  return {index, x - float(index)};
}

GgxAlbedo mix(float t, const GgxAlbedo& a, const GgxAlbedo& b) {
  return {lerp(t, a.scale, b.scale), lerp(t, a.bias, b.bias)};
}

}  // namespace

GgxAlbedo ggx_albedo(float cos_theta, float alpha) {
  const auto [i, ti] = locate(cos_theta, cosines);
  const auto [j, tj] = locate(alpha, widths);
  const auto& low = table().directional[j];
  const auto& high = table().directional[j + 1];
  return mix(tj, mix(ti, low[i], low[i + 1]), mix(ti, high[i], high[i + 1]));
}

GgxAlbedo ggx_average_albedo(float alpha) {
  const auto [j, tj] = locate(alpha, widths);
  return mix(tj, table().average[j], table().average[j + 1]);
}

}  // namespace vernier
