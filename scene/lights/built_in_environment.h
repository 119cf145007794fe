// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vernier/scene.h"

namespace vernier {

/// Surroundings that need no file.
struct BuiltInEnvironment {
  std::string name;
  std::string description;
  bool turns_with_camera = false;  ///< its rotation counts from the way the camera looks
  std::shared_ptr<const Image> (*picture)();
};

/// - "studio": a photographer's. Softboxes in a neutral grey room, as seen by a camera that looks along -z:
///   the key light from the upper left behind it, a large and dim fill on the right, a soft one overhead, and
///   two strips at the sides behind the subject that draw its outline. The floor and the backdrop, which are
///   what the camera sees behind the subject, are one smooth gradient. A white diffuse surface facing up
///   shows close to 0.9.
/// - "sky": radiance 1 overhead falling to 0.6 at the horizon, and 0.3 below it.
const std::vector<BuiltInEnvironment>& built_in_environments();

/// Radians counter-clockwise about +y that turn what lies along -z to where a camera looks; for one that
/// looks straight up or down, to where the lower or upper edge of its picture points.
float heading(const CameraDescription& camera);

}  // namespace vernier
