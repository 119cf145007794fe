// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/scene_summary.h"

#include <nlohmann/json.hpp>
#include <set>

namespace vernier::apps {

SceneCounts count(const SceneDescription& scene) {
  SceneCounts counts;
  counts.meshes = scene.meshes.size();
  counts.instances = scene.instances.size();
  counts.materials = scene.materials.size();
  counts.textures = scene.textures.size();
  counts.cameras = scene.cameras.size();
  counts.punctual_lights = scene.lights.size();
  counts.environment = scene.environment != nullptr;
  for (const auto& mesh : scene.meshes) {
    counts.vertices += mesh.positions.size();
    counts.triangles += mesh.triangles.size();
  }
  for (const auto& instance : scene.instances) {
    const uint64_t triangles = scene.meshes[instance.mesh].triangles.size();
    counts.instanced_triangles += triangles;
    const Rgb& emissive = scene.materials[instance.material].emissive;
    if (emissive.x > 0 || emissive.y > 0 || emissive.z > 0) counts.emissive_triangles += triangles;
  }
  std::set<const void*> images;
  for (const auto& texture : scene.textures)
    texture.with_image([&](const auto& image) {
      if (images.insert(&image).second) counts.texture_bytes += image.values.size() * sizeof(image.values[0]);
    });
  return counts;
}

nlohmann::ordered_json to_json(const SceneCounts& counts) {
  return {{"meshes", counts.meshes},
          {"instances", counts.instances},
          {"vertices", counts.vertices},
          {"triangles", counts.triangles},
          {"instanced_triangles", counts.instanced_triangles},
          {"materials", counts.materials},
          {"textures", counts.textures},
          {"texture_bytes", counts.texture_bytes},
          {"cameras", counts.cameras},
          {"punctual_lights", counts.punctual_lights},
          {"emissive_triangles", counts.emissive_triangles},
          {"environment", counts.environment}};
}

}  // namespace vernier::apps
