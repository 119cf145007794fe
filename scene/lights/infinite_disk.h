// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/frame.h"
#include "core/sampling/warp.h"
#include "scene/lights/light.h"

namespace vernier {

/// Light from infinity that travels along the unit `direction`: `irradiance` on what faces it, over the
/// density of that direction. It begins on the disk outside of the scene through which all must pass that
/// can meet the scene.
inline std::optional<LightRay> emit_from_infinity(const Bounds& scene, const Vec3f& direction,
                                                  const Rgb& irradiance, const Vec2f& u, float time) {
  // Rounding must leave no corner out.
  const float radius = scene.radius() * 1.001f;
  if (!(radius > 0) || is_black(irradiance)) return std::nullopt;
  const Vec2f on_disk = sample_disk(u) * radius;
  const Vec3f origin =
      scene.center() + Frame::from_normal(direction).to_world({on_disk.x, on_disk.y, -radius});
  LightRay light{{origin, 0, direction}, irradiance * (pi * square(radius))};
  light.ray.time = time;
  return light;
}

}  // namespace vernier
