// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_bytes.h"

namespace vernier {

uint64_t bytes_to_build(const SceneDescription& scene) {
  // Of 2 million triangles in a mesh the peak was 90 bytes each, of a million that glow 460; instances keep
  // 606 (docs/speed.md).
  constexpr uint64_t of_triangle = 100, of_glowing_triangle = 400, of_instance = 700;
  uint64_t bytes = scene.instances.size() * of_instance;
  for (const MeshDescription& mesh : scene.meshes) bytes += mesh.triangles.size() * of_triangle;
  for (const InstanceDescription& instance : scene.instances)
    if (max_component(scene.materials[instance.material].emissive) > 0)
      bytes += scene.meshes[instance.mesh].triangles.size() * of_glowing_triangle;
  return bytes;
}

}  // namespace vernier
