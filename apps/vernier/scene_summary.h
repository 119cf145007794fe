// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "vernier/scene.h"

namespace vernier::apps {

/// How much of what a scene description holds.
struct SceneCounts {
  size_t meshes = 0, instances = 0, materials = 0, textures = 0, cameras = 0;
  size_t punctual_lights = 0, emissive_triangles = 0;  ///< triangles as instanced
  uint64_t vertices = 0;
  uint64_t triangles = 0;              ///< stored: each mesh once
  uint64_t instanced_triangles = 0;    ///< as they stand in the world
  uint64_t texture_bytes = 0;          ///< decoded pixels, each image once
  uint64_t texture_bytes_in_file = 0;  ///< of these in a temporary file, for --max-memory
  bool environment = false;
};

SceneCounts count(const SceneDescription& scene);

/// "12.3 MB decoded", and how much of it is in a file.
std::string texture_bytes_text(const SceneCounts& counts);

nlohmann::ordered_json to_json(const SceneCounts& counts);

}  // namespace vernier::apps
