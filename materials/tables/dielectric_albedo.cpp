// SPDX-License-Identifier: Apache-2.0
#include "materials/tables/dielectric_albedo.h"

#include <map>
#include <memory>

#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/tables/albedo_table_mapping.h"

namespace vernier {
namespace {

constexpr float least_alpha = 1e-4f;

}  // namespace

const DielectricAlbedo& DielectricAlbedo::of(float eta) {
  static std::mutex mutex;
  static std::map<float, std::unique_ptr<DielectricAlbedo>> tables;
  const std::lock_guard lock(mutex);
  auto& table = tables[eta];
  if (!table) table = std::make_unique<DielectricAlbedo>(eta);
  return *table;
}

/// Mean over visible normals, on one side of the plane of wo since the other mirrors it. The kinks at total
/// internal reflection and at both horizons would spoil a product rule; a Fibonacci lattice does not mind
/// them (Niederreiter 1992, "Random Number Generation and Quasi-Monte Carlo Methods", chapter 5).
DielectricAlbedo::Node DielectricAlbedo::integrate(float cos_theta, float alpha) const {
  constexpr int points = 2584, generator = 1597;
  const float z = std::max({cos_theta, 1e-5f * alpha, 1e-7f});
  const Vec3f wo(safe_sqrt(1 - z * z), 0, z);
  const Ggx ggx{alpha, alpha};
  const float lambda_o = ggx.lambda(wo);
  double total = 0, exchange_all = 0, exchange_fresnel = 0;
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
    if (fresnel >= 1) continue;
    exchange_all += r - t;
    exchange_fresnel += fresnel * (r - t);
  }
  return {float(1 - total / points), float(exchange_all / points), float(exchange_fresnel / points)};
}

const DielectricAlbedo::Row& DielectricAlbedo::row(int index) const {
  Row& row = rows_[index];
  std::call_once(row.once, [&] {
    const float alpha = std::max(square(float(index) / (widths - 1)), least_alpha);
    for (int i = 0; i < Row::cosines; ++i)
      row.nodes[i] = integrate(albedo_cosine(float(i) / (Row::cosines - 1), alpha), alpha);
  });
  return row;
}

DielectricAlbedo::Node DielectricAlbedo::Node::mix(float t, const Node& a, const Node& b) {
  return {lerp(t, a.missing, b.missing), lerp(t, a.exchange_all, b.exchange_all),
          lerp(t, a.exchange_fresnel, b.exchange_fresnel)};
}

DielectricAlbedo::Node DielectricAlbedo::Row::at(float coordinate) const {
  const float x = coordinate * (cosines - 1);
  const int i = std::min(int(x), cosines - 2);
  return Node::mix(x - float(i), nodes[size_t(i)], nodes[size_t(i) + 1]);
}

float DielectricAlbedo::albedo(float cos_theta, float alpha, const SchlickCurve& ends) const {
  const float a = std::clamp(alpha, least_alpha, 1.f);
  const float x = albedo_coordinate(cos_theta, a);
  const float y = std::sqrt(a) * (widths - 1);
  const int j = std::min(int(y), widths - 2);
  const Node node = Node::mix(y - float(j), row(j).at(x), row(j + 1).at(x));
  // The curve between the ends is offset + slope F; an infinite index leaves no curve.
  const float f0 = f0_from_ior(eta_);
  const float slope = f0 < 0.999f ? (ends.f90 - ends.f0) / (1 - f0) : 0;
  const float offset = ends.f0 - slope * f0;
  return 1 - node.missing + offset * node.exchange_all + (slope - 1) * node.exchange_fresnel;
}

}  // namespace vernier
