// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/sampling/sampler.h"
#include "scene/scene.h"
#include "scene/segment.h"

namespace vernier {

/// Irradiance of the scene's lights at surface points, with what stands in their way and without: sums over
/// samples, whose quotient is the part that arrives.
struct ShadowSums {
  Rgb arriving{0, 0, 0}, unhindered{0, 0, 0};

  /// Adds some light samples on the side of a surface that wo points to. Light that arrives bent does not
  /// count, since no shadow ray finds it.
  void add(const Scene& scene, const Interaction& at, const Vec3f& wo, Sampler sampler);

  /// Between 0 and 1 by channel; 1 where no light would arrive in any case.
  Rgb lit() const;
};

}  // namespace vernier
