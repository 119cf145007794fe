// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/scene_summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "core/base/quantities.h"
#include "materials/texture_pixels.h"

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
  for (const auto& texture : scene.textures) {
    const TexturePixels& pixels = texture.pixels();
    if (!images.insert(std::visit([](const auto& image) -> const void* { return image.get(); }, pixels))
             .second)
      continue;
    counts.texture_bytes += texel_bytes(pixels);
    if (file_of(pixels)) counts.texture_bytes_in_file += texel_bytes(pixels);
  }
  return counts;
}

std::string texture_bytes_text(const SceneCounts& counts) {
  std::string decoded = format_bytes(double(counts.texture_bytes)) + " decoded";
  if (counts.texture_bytes_in_file == 0) return decoded;
  return fmt::format("{}, {} of it in a file", decoded, format_bytes(double(counts.texture_bytes_in_file)));
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
          {"texture_bytes_in_file", counts.texture_bytes_in_file},
          {"cameras", counts.cameras},
          {"punctual_lights", counts.punctual_lights},
          {"emissive_triangles", counts.emissive_triangles},
          {"environment", counts.environment}};
}

}  // namespace vernier::apps
