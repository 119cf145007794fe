// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/bounds.h"

namespace vernier {

/// Point that light is wanted at. With a normal, light from below its horizon is worth nothing.
struct LightReceiver {
  Vec3f position;
  Vec3f normal{0, 0, 0};  ///< unit, or zero: light from all sides counts
};

/// Where a light or a group of them is, where it shines to and how strongly: emission lies within
/// `cos_emission` of some direction that lies within `cos_spread` of `axis`.
struct LightBounds {
  Bounds box;
  Vec3f axis{0, 0, 1};
  float cos_spread = 1;
  float cos_emission = 0;
  float power = 0;
  bool two_sided = false;  ///< shines along -axis likewise
};

/// Bounds of both.
LightBounds merge(const LightBounds& a, const LightBounds& b);

}  // namespace vernier
