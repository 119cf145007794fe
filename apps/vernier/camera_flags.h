// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "apps/vernier/commands.h"
#include "apps/vernier/lens.h"
#include "vernier/ground.h"

namespace vernier::apps {

/// How the scene is to be seen, as typed. Angles in degrees.
struct CameraFlags {
  std::string camera;  ///< of the scene, name or number
  std::optional<float> azimuth, elevation;
  std::string fit;  ///< margin; empty: not given
  std::string look_from, look_at, up;
  float roll = 0, zoom = 1;
  std::optional<float> fov;
  bool ortho = false;
  std::optional<float> ortho_height;  ///< metres
  bool panorama = false;
  LensFlags lens;
  std::optional<GroundKind> ground;  ///< put under the scene, which the camera is fitted without
  bool turns = false;                ///< the scene is seen from all around

  /// Whether the camera is to stand where the scene fits the picture.
  bool orbits() const { return azimuth || elevation || !fit.empty(); }
};

/// Declares the flags on `command`. Throws Error(usage), when it is parsed, on flags that contradict each
/// other.
void add_camera_flags(CLI::App& command, CameraFlags& flags);

}  // namespace vernier::apps
