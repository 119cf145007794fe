// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

#include "scene/accel/accelerator.h"

// What the accelerators share about rays and lists of hits.

namespace vernier {

/// Whether the ray can hit anything: finite, with a direction, and an interval that is not empty for t > 0.
inline bool is_traceable(const Ray& ray) {
  constexpr float largest = std::numeric_limits<float>::max();
  const float size = std::abs(ray.direction.x) + std::abs(ray.direction.y) + std::abs(ray.direction.z);
  const float distance = std::abs(ray.origin.x) + std::abs(ray.origin.y) + std::abs(ray.origin.z);
  return size > 0 && size <= largest && distance <= largest && ray.t_min < ray.t_max && ray.t_max > 0;
}

inline bool has_clear_instances(const Geometry& geometry) {
  return std::any_of(geometry.instances.begin(), geometry.instances.end(),
                     [](const GeometryInstance& instance) { return instance.clear; });
}

/// The float before t; t > 0.
inline float below(float t) { return std::bit_cast<float>(std::bit_cast<uint32_t>(t) - 1); }

/// A ray with its direction scaled by a power of two to about unit length, and t counted in that.
struct ScaledRay {
  Ray ray;
  float t_scale;  ///< times the t of `ray` is the t of the ray it was made from
};

/// Empty when the ray can hit nothing.
std::optional<ScaledRay> scaled_to_unit(const Ray& ray);

/// Sorts by t, then instance, then primitive, and drops repeats of a triangle.
void sort_hits(std::vector<RawHit>& hits);

}  // namespace vernier
