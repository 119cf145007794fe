#include "scene/import/instances.h"

#include <fmt/format.h>

#include "core/base/names.h"
#include "scene/import/accessors.h"
#include "scene/import/materials.h"
#include "scene/import/primitive_data.h"

namespace vernier {
namespace {

using Imath::M44d;

/// Index of a variant by name; -1 when none is asked for.
int find_variant(const Document& document, const std::string& wanted) {
  if (wanted.empty()) return -1;
  std::vector<std::string> names;
  const auto extension = document.model().extensions.find("KHR_materials_variants");
  if (extension != document.model().extensions.end()) {
    const auto& variants = extension->second.Get("variants");
    for (int i = 0; i < int(variants.ArrayLen()); ++i) {
      names.push_back(variants.Get(i).Get("name").Get<std::string>());
      if (names.back() == wanted) return i;
    }
  }
  throw_unknown_name("variant", wanted, names);
}

/// Matrices of EXT_mesh_gpu_instancing, to the node's own space; none when the node has not got it.
std::vector<M44d> instance_matrices(const Document& document, int index) {
  const auto& extensions = document.model().nodes[size_t(index)].extensions;
  const auto extension = extensions.find("EXT_mesh_gpu_instancing");
  if (extension == extensions.end()) return {};
  const auto& attributes = extension->second.Get("attributes");
  std::vector<NodePose> poses;
  const auto pose_at = [&](const std::string& name, size_t i, size_t count) -> NodePose& {
    if (poses.empty()) poses.resize(count);
    if (poses.size() != count)
      document.fail(fmt::format("/nodes/{}/extensions/EXT_mesh_gpu_instancing/attributes/{}", index, name),
                    fmt::format("{} values for {} instances", count, poses.size()));
    return poses[i];
  };
  for (const auto& name : attributes.Keys()) {
    const int accessor = attributes.Get(name).GetNumberAsInt();
    if (name == "ROTATION") {
      const auto values = read_vectors<Vec4f>(document, accessor);
      for (size_t i = 0; i < values.size(); ++i)
        pose_at(name, i, values.size()).rotation =
            Imath::Quatd(values[i].w, values[i].x, values[i].y, values[i].z).normalized();
    } else if (name == "TRANSLATION" || name == "SCALE") {
      const auto values = read_vectors<Vec3f>(document, accessor);
      for (size_t i = 0; i < values.size(); ++i) {
        NodePose& pose = pose_at(name, i, values.size());
        (name == "SCALE" ? pose.scale : pose.translation) = Vec3d(values[i]);
      }
    }
  }
  std::vector<M44d> matrices;
  matrices.reserve(poses.size());
  for (const auto& pose : poses) matrices.push_back(pose.to_parent());
  return matrices;
}

/// The texture whose axes a material's tangents follow; none when it needs no tangents.
std::optional<TextureUse> tangent_map(const MaterialDescription& m) {
  if (m.normal_texture) return m.normal_texture;
  if (m.clearcoat_normal_texture) return m.clearcoat_normal_texture;
  if (m.anisotropy > 0) return m.anisotropy_texture;
  return std::nullopt;
}

}  // namespace

InstancePlacer::InstancePlacer(const Document& document, const std::vector<MaterialDescription>& materials,
                               const std::string& variant)
    : document_(document), materials_(materials), variant_(find_variant(document, variant)) {}

void InstancePlacer::add_node(int index, const NodePlaces& places, const NodePose& pose) {
  const auto& node = document_.model().nodes[size_t(index)];
  if (node.mesh < 0) return;
  const auto& mesh = document_.model().meshes[size_t(node.mesh)];
  for (size_t i = 0; i < mesh.primitives.size(); ++i) {
    const auto& primitive = mesh.primitives[i];
    if (!has_surface(document_, primitive)) {
      ++result_.without_surface;
      continue;
    }
    MeshUse use{node.mesh, int(i), node.skin, {}};
    if (!primitive.targets.empty()) use.weights = pose.weights.empty() ? mesh.weights : pose.weights;
    InstanceDescription instance;
    instance.name = node.name;
    instance.material = material_of(primitive);
    instance.mesh = mesh_of(std::move(use), instance.material);
    // A skinned mesh is where its joints are; its own node does not count (glTF 2.0, 3.7.3.3).
    if (node.skin >= 0)
      result_.instances.push_back(std::move(instance));
    else
      add_instances(index, instance, places.to_world[size_t(index)]);
  }
}

void InstancePlacer::add_instances(int node, const InstanceDescription& prototype, const M44d& to_world) {
  const std::string place = fmt::format("/nodes/{}", node);
  const bool instanced =
      document_.model().nodes[size_t(node)].extensions.count("EXT_mesh_gpu_instancing") > 0;
  const std::vector<M44d> matrices =
      instanced ? instance_matrices(document_, node) : std::vector<M44d>{M44d()};
  for (const auto& matrix : matrices) {
    result_.instances.push_back(prototype);
    result_.instances.back().to_world = to_transform(document_, matrix * to_world, place);
  }
}

uint32_t InstancePlacer::material_of(const tinygltf::Primitive& primitive) const {
  const auto extension = primitive.extensions.find("KHR_materials_variants");
  if (variant_ >= 0 && extension != primitive.extensions.end()) {
    const auto& mappings = extension->second.Get("mappings");
    for (int m = 0; m < int(mappings.ArrayLen()); ++m) {
      const auto& variants = mappings.Get(m).Get("variants");
      for (int v = 0; v < int(variants.ArrayLen()); ++v)
        if (variants.Get(v).GetNumberAsInt() == variant_)
          return uint32_t(mappings.Get(m).Get("material").GetNumberAsInt());
    }
  }
  return primitive.material >= 0 ? uint32_t(primitive.material) : uint32_t(materials_.size() - 1);
}

uint32_t InstancePlacer::mesh_of(MeshUse use, uint32_t material) {
  const auto [found, is_new] = meshes_.try_emplace(use, uint32_t(result_.meshes.size()));
  if (!is_new) return found->second;
  MeshRequest request;
  request.use = std::move(use);
  request.tangent_map = tangent_map(materials_[material]);
  if (request.tangent_map) request.texcoords[size_t(request.tangent_map->texcoord)] = true;
  for_each_texture(materials_[material], [&](const TextureUse& texture) {
    if (texture) request.texcoords[size_t(texture.texcoord)] = true;
  });
  result_.meshes.push_back(std::move(request));
  return found->second;
}

}  // namespace vernier
