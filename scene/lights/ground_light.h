// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/sampling/distribution.h"
#include "scene/lights/environment.h"

namespace vernier {

/// The light that falls on level ground from above where nothing is in its way: of an environment and of
/// punctual lights. Surfaces that emit stand on the ground, and what they add to it is no shadow.
class GroundLight {
 public:
  /// Either may be missing: null, empty. They must live as long.
  GroundLight(const EnvironmentLight* environment, std::vector<const Light*> lamps);

  /// A direction in proportion to the irradiance, by luminance, that arrives from it; u chooses the light, v
  /// the point on it. The part of the samples that gets through is the part of the light that does. Empty
  /// where no light falls; pdf is not set.
  std::optional<LightSample> sample(const SurfacePoint& from, double u, const Vec2d& v) const;

 private:
  const EnvironmentLight* environment_;
  std::vector<const Light*> lamps_;
  Distribution2D upper_half_;  ///< of the environment's picture: luminance, cosine and solid angle
  double environment_irradiance_ = 0;
  float rows_share_ = 0.5f;  ///< of the picture that lies above the horizon
};

}  // namespace vernier
