// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>

#include "scene/lights/light_group.h"

namespace vernier {

/// Lights that a tree keeps together while it is built.
struct LightRange {
  std::span<PlacedLight> lights;
  LightGroup group;
  int depth = 0;  ///< splits above
  /// How little is known of what the group sends where: its power by its area and by the solid angle that its
  /// emission covers (Conty Estevez and Kulla 2018, eqs. 1 and 2).
  float unknown = 0;

  size_t size() const { return lights.size(); }
};

LightRange range_of(std::span<PlacedLight> lights);

/// Divides a range of two lights at least where it costs least. Moves its lights about, in a way that does
/// not depend on the number of threads, which all take part in what is worth it.
std::pair<LightRange, LightRange> split(const LightRange& range);

/// The bounds of all of its lights together.
LightBounds bounds_of(const LightRange& range);

}  // namespace vernier
