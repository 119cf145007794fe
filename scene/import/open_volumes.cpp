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

/// A primitive by the weights it is morphed with; those without morph targets have none.
using Shapes = std::map<std::vector<double>, const MeshDescription*>;

/// Morphing may tear a surface open.
bool is_closed_in_every_shape(const std::map<int, Shapes>& primitives) {
  std::set<std::vector<double>> all_weights;
  for (const auto& [primitive, shapes] : primitives)
    for (const auto& [weights, mesh] : shapes) all_weights.insert(weights);
  for (const auto& weights : all_weights) {
    std::vector<const MeshDescription*> parts;
    for (const auto& [primitive, shapes] : primitives) {
      auto shape = shapes.find(weights);
      if (shape == shapes.end()) shape = shapes.find({});
      if (shape != shapes.end()) parts.push_back(shape->second);
    }
    // Some primitive is only there in other shapes.
    if (parts.size() < primitives.size()) continue;
    if (!is_closed_surface(parts)) return false;
  }
  return true;
}

}  // namespace

void notice_open_volumes(const std::vector<MeshRequest>& requests,
                         const std::vector<ImportedMaterial>& materials, SceneDescription& scene) {
  // Each primitive of a mesh under a skin, in each of its shapes.
  std::map<std::pair<int, int>, std::map<int, Shapes>> meshes;
  for (const auto& instance : scene.instances)
    if (bounds_volume(materials[instance.material].description)) {
      const MeshUse& use = requests[instance.mesh].use;
      meshes[{use.mesh, use.skin}][use.primitive][use.weights] = &scene.meshes[instance.mesh];
    }
  std::set<int> open;
  for (const auto& [mesh_and_skin, primitives] : meshes) {
    const int mesh = mesh_and_skin.first;
    if (open.count(mesh) || is_closed_in_every_shape(primitives)) continue;
    open.insert(mesh);
    const std::string& name = primitives.begin()->second.begin()->second->name;
    scene.notices.push_back(
        {Notice::Severity::warning, fmt::format("/meshes/{}", mesh),
         fmt::format(
             "the mesh{} is not closed; its volume (KHR_materials_volume) needs a closed surface to have an "
             "inside. Close it, or set thicknessFactor to 0 for a thin wall",
             name.empty() ? "" : fmt::format(" '{}'", name))});
  }
}

}  // namespace vernier
