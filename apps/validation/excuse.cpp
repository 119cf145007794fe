// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/excuse.h"

namespace vernier::validation {

Excuse excuse(const Ray& ray, const std::optional<Corners>& a, const std::optional<Corners>& b,
              double distortion) {
  const auto at_boundary = [&](const std::optional<Corners>& met) {
    return met && distance_to_boundary(ray, *met) <= 4 * distortion * coordinate_ulp(ray, *met);
  };
  if (at_boundary(a) || at_boundary(b)) return Excuse::boundary;
  struct Place {
    double t = 0, bound = 0;
  };
  const auto place = [&](const std::optional<Corners>& met) -> std::optional<Place> {
    if (!met) return std::nullopt;
    const ExactHit hit = intersect_exactly(ray, *met);
    return Place{hit.t, distortion * hit.t_bound};
  };
  const auto at_a = place(a), at_b = place(b);
  const auto at_end = [&](const std::optional<Place>& at) {
    return at && (std::abs(at->t - ray.t_min) <= at->bound || std::abs(at->t - ray.t_max) <= at->bound);
  };
  if (at_end(at_a) || at_end(at_b)) return Excuse::end;
  if (at_a && at_b && std::abs(at_a->t - at_b->t) <= at_a->bound + at_b->bound) return Excuse::tie;
  return Excuse::none;
}

}  // namespace vernier::validation
