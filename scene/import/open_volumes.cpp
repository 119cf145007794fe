#include "scene/import/open_volumes.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "scene/closed_surface.h"

namespace vernier {
namespace {

bool bounds_volume(const MaterialDescription& material) {
  return material.thickness > 0 && (material.transmission > 0 || material.diffuse_transmission > 0);
}

}  // namespace

void notice_open_volumes(const std::vector<MeshRequest>& requests,
                         const std::vector<ImportedMaterial>& materials, SceneDescription& scene) {
  std::set<uint32_t> boundaries;
  for (const auto& instance : scene.instances)
    if (bounds_volume(materials[instance.material].description)) boundaries.insert(instance.mesh);
  // A mesh in each of its shapes: what morphing or a skin tears open is open.
  std::map<MeshUse, std::vector<const MeshDescription*>> surfaces;
  for (const uint32_t mesh : boundaries) {
    MeshUse shape = requests[mesh].use;
    shape.primitive = 0;
    surfaces[shape].push_back(&scene.meshes[mesh]);
  }
  std::set<int> open;
  for (const auto& [shape, parts] : surfaces)
    if (!is_closed_surface(parts) && open.insert(shape.mesh).second)
      scene.notices.push_back(
          {Notice::Severity::warning, fmt::format("/meshes/{}", shape.mesh),
           fmt::format("the mesh{} is not closed; its volume (KHR_materials_volume) needs a closed surface "
                       "to have an inside. Close it, or set thicknessFactor to 0 for a thin wall",
                       parts[0]->name.empty() ? "" : fmt::format(" '{}'", parts[0]->name))});
}

}  // namespace vernier
