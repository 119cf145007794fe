#include "scene/import/instances.h"

#include <fmt/format.h>

#include <map>

#include "scene/import/materials.h"
#include "scene/import/primitive_data.h"

namespace vernier {
namespace {

class Placer {
 public:
  Placer(const Document& document, const std::vector<MaterialDescription>& materials)
      : document_(document), materials_(materials) {}

  void add_node(int index, const Imath::M44d& to_world) {
    const auto& node = document_.model().nodes[size_t(index)];
    if (node.mesh < 0) return;
    const Transform transform = to_transform(document_, to_world, fmt::format("/nodes/{}", index));
    const auto& primitives = document_.model().meshes[size_t(node.mesh)].primitives;
    for (size_t i = 0; i < primitives.size(); ++i) {
      if (!has_surface(document_, primitives[i])) {
        ++result_.without_surface;
        continue;
      }
      const uint32_t material = material_of(primitives[i]);
      result_.instances.push_back({node.name, mesh_of(node.mesh, int(i), material), material, transform});
    }
  }

  Placement take() { return std::move(result_); }

 private:
  uint32_t material_of(const tinygltf::Primitive& primitive) const {
    return primitive.material >= 0 ? uint32_t(primitive.material) : uint32_t(materials_.size() - 1);
  }

  uint32_t mesh_of(int mesh, int primitive, uint32_t material) {
    const auto [found, is_new] = meshes_.try_emplace({mesh, primitive}, uint32_t(result_.meshes.size()));
    if (is_new) {
      MeshRequest request;
      request.mesh = mesh;
      request.primitive = primitive;
      request.tangents = needs_tangents(materials_[material]);
      for_each_texture(materials_[material], [&](const TextureUse& use) {
        if (use) request.texcoords[size_t(use.texcoord)] = true;
      });
      result_.meshes.push_back(request);
    }
    return found->second;
  }

  const Document& document_;
  const std::vector<MaterialDescription>& materials_;
  std::map<std::pair<int, int>, uint32_t> meshes_;
  Placement result_;
};

}  // namespace

Placement place_meshes(const Document& document, const NodePlaces& places,
                       const std::vector<MaterialDescription>& materials) {
  Placer placer(document, materials);
  for (const int node : places.shown) placer.add_node(node, places.to_world[size_t(node)]);
  return placer.take();
}

}  // namespace vernier
