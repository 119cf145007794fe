// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/math/ray.h"
#include "vernier/scene.h"

namespace vernier::test {

/// A scene of boxes, spheres, sheets and lamps of every material and kind of light there is, with what is in,
/// across, against and instead of each other left to chance; a pure function of the seed.
struct RandomScene {
  SceneDescription description;
  std::vector<Ray> rays;
  int max_depth = 0;
  bool has_lamps = false;  ///< which BSDF sampling alone never finds
};
RandomScene random_scene(uint64_t seed);

/// The scene as one glTF file, to be looked at with any program; textures are left out but for their alpha.
std::string to_gltf(const SceneDescription& description);

}  // namespace vernier::test
