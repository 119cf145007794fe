// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/query.h"

#include <algorithm>
#include <tuple>

namespace vernier {

std::optional<ScaledRay> scaled_to_unit(const Ray& ray) {
  if (!is_traceable(ray)) return {};
  int exponent = 0;
  std::frexp(max_component(abs(ray.direction)), &exponent);
  Ray scaled = ray;
  for (int axis = 0; axis < 3; ++axis) scaled.direction[axis] = std::ldexp(ray.direction[axis], -exponent);
  scaled.t_min = std::ldexp(std::max(ray.t_min, 0.f), exponent);
  scaled.t_max = std::ldexp(ray.t_max, exponent);
  if (!(scaled.t_max > scaled.t_min)) return {};
  return ScaledRay{scaled, std::ldexp(1.f, -exponent)};
}

void sort_hits(std::vector<RawHit>& hits) {
  const auto key = [](const RawHit& h) { return std::tuple(h.t, h.instance, h.primitive); };
  std::sort(hits.begin(), hits.end(), [&](const RawHit& a, const RawHit& b) { return key(a) < key(b); });
  const auto same = [](const RawHit& a, const RawHit& b) {
    return a.instance == b.instance && a.primitive == b.primitive;
  };
  hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
}

}  // namespace vernier
