#include "materials/glass_energy.h"

#include <map>
#include <memory>

#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/ggx_coordinates.h"

namespace vernier {
namespace {

constexpr float least_alpha = 1e-4f;

}  // namespace

const GlassEnergy& GlassEnergy::of(float eta) {
  static std::mutex mutex;
  static std::map<float, std::unique_ptr<GlassEnergy>> tables;
  const std::lock_guard lock(mutex);
  auto& table = tables[eta];
  if (!table) table = std::make_unique<GlassEnergy>(eta);
  return *table;
}

/// Mean over visible normals, on one side of the plane of wo since the other mirrors it. The kinks at total
/// internal reflection and at both horizons would spoil a product rule; a Fibonacci lattice does not mind
/// them (Niederreiter 1992, "Random Number Generation and Quasi-Monte Carlo Methods", chapter 5).
GlassEnergy::Node GlassEnergy::integrate(float cos_theta, float alpha) const {
  constexpr int points = 2584, generator = 1597;
  const float z = std::max({cos_theta, 1e-5f * alpha, 1e-7f});
  const Vec3f wo(safe_sqrt(1 - z * z), 0, z);
  const Ggx ggx{alpha, alpha};
  const float lambda_o = ggx.lambda(wo);
  double total = 0, exchange = 0;
  for (int k = 0; k < points; ++k) {
    const float x = (float(k * generator % points) + 0.5f) / points, y = (float(k) + 0.5f) / points;
    const Vec3f m = ggx.sample_visible(wo, {x / 2, y});
    const float cos_om = dot(wo, m);
    float cos_t;
    const float fresnel = fresnel_dielectric(cos_om, eta_, cos_t);
    const Vec3f reflected = 2 * cos_om * m - wo;
    const Vec3f refracted = (cos_om / eta_ - cos_t) * m - wo / eta_;
    const float r = reflected.z > 0 ? (1 + lambda_o) / (1 + lambda_o + ggx.lambda(reflected)) : 0;
    const float t = refracted.z < 0 ? (1 + lambda_o) / (1 + lambda_o + ggx.lambda(refracted)) : 0;
    total += fresnel * r + (1 - fresnel) * t;
    if (fresnel < 1) exchange += fresnel * (r - t);
  }
  return {float(1 - total / points), float(exchange / points)};
}

const GlassEnergy::Row& GlassEnergy::row(int index) const {
  Row& row = rows_[index];
  std::call_once(row.once, [&] {
    const float alpha = std::max(square(float(index) / (widths - 1)), least_alpha);
    for (int i = 0; i < Row::cosines; ++i)
      row.nodes[i] = integrate(albedo_cosine(float(i) / (Row::cosines - 1), alpha), alpha);
  });
  return row;
}

GlassEnergy::Node GlassEnergy::Row::at(float coordinate) const {
  const float x = coordinate * (cosines - 1);
  const int i = std::min(int(x), cosines - 2);
  const float t = x - float(i);
  return {lerp(t, nodes[i].missing, nodes[i + 1].missing), lerp(t, nodes[i].exchange, nodes[i + 1].exchange)};
}

Rgb GlassEnergy::albedo(float cos_theta, float alpha, const Rgb& reflect_scale) const {
  const float a = std::clamp(alpha, least_alpha, 1.f);
  const float x = albedo_coordinate(cos_theta, a);
  const float y = std::sqrt(a) * (widths - 1);
  const int j = std::min(int(y), widths - 2);
  const Node low = row(j).at(x), high = row(j + 1).at(x);
  const float missing = lerp(y - float(j), low.missing, high.missing);
  const float exchange = lerp(y - float(j), low.exchange, high.exchange);
  Rgb result;
  for (int c = 0; c < 3; ++c) {
    const float change = (reflect_scale[c] - 1) * exchange;
    result[c] = 1 - missing + (reflect_scale[c] > 1 ? std::clamp(change, 0.f, missing) : change);
  }
  return result;
}

}  // namespace vernier
