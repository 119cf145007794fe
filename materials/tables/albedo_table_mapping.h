// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/math.h"

// Facets block each other most where the cosine of a direction is about alpha, and there the albedo of a GGX
// lobe is a function of their ratio alone as alpha goes to zero. The coordinate of tables of albedos gives
// half its nodes to that ratio and half to the cosine, denser toward grazing.

namespace vernier {

/// In [0, 1], rising with the cosine.
inline float albedo_coordinate(float cos_theta, float alpha) {
  return std::sqrt((cos_theta * (1 + alpha) / (cos_theta + alpha) + cos_theta) / 2);
}

/// Inverse of albedo_coordinate().
inline float albedo_cosine(float coordinate, float alpha) {
  const float c = coordinate * coordinate;
  const float b = 1 + 2 * alpha - 2 * c;
  return (std::sqrt(b * b + 8 * c * alpha) - b) / 2;
}

}  // namespace vernier
