// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_bytes.h"

#include <fmt/format.h>

#include "core/base/quantities.h"
#include "core/base/resident_memory.h"
#include "vernier/error.h"
#include "vernier/memory.h"

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

void check_scene_size(const SceneDescription& scene, const MemoryLimit& limit) {
  if (limit.bytes == 0) return;
  const double taken = double(resident_bytes()), more = double(bytes_to_build(scene));
  if (taken + more <= double(limit.bytes)) return;
  size_t triangles = 0;
  for (const MeshDescription& mesh : scene.meshes) triangles += mesh.triangles.size();
  throw Error(
      ErrorKind::memory, scene.source, {},
      fmt::format(
          "to build a scene of {} triangles takes about {} of memory beside {} that are taken, "
          "and the limit is {}; raise it (--max-memory, max_memory), or take a scene of fewer triangles",
          format_count(double(triangles)), format_bytes(more), format_bytes(taken),
          format_bytes(double(limit.bytes))));
}

}  // namespace vernier
