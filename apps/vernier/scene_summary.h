// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "vernier/scene.h"

namespace vernier::apps {

/// How much of what a scene description holds.
struct SceneCounts {
  size_t meshes = 0, instances = 0, materials = 0, textures = 0, cameras = 0;
  size_t punctual_lights = 0, emissive_triangles = 0;  ///< triangles as instanced
  uint64_t vertices = 0;
  uint64_t triangles = 0;            ///< stored: each mesh once
  uint64_t instanced_triangles = 0;  ///< as they stand in the world
  uint64_t texture_bytes = 0;        ///< decoded pixels, each image once
  bool environment = false;
};

SceneCounts count(const SceneDescription& scene);

nlohmann::ordered_json to_json(const SceneCounts& counts);

}  // namespace vernier::apps
