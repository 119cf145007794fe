// SPDX-License-Identifier: Apache-2.0
#include "scene/import/instances.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/names.h"
#include "scene/import/accessors.h"
#include "scene/import/thin_bodies.h"

namespace vernier {
namespace {

using Imath::M44d;

/// Index of a variant by name; -1 when none is asked for.
int find_variant(const Document& document, const std::string& wanted) {
  if (wanted.empty()) return -1;
  const std::vector<std::string> names = variant_names(document);
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found == names.end()) throw_unknown_name("variant", wanted, names);
  return int(found - names.begin());
}

/// Matrices of EXT_mesh_gpu_instancing, to the node's own space: one a value of its attributes, of which
/// those that are not known leave instances where the node is.
std::vector<M44d> instance_matrices(const Document& document, int index, const tinygltf::Value& attributes) {
  std::vector<NodePose> poses;
  const auto names = attributes.Keys();
  if (names.empty()) return {M44d()};
  for (const auto& name : names) {
    const int accessor = attributes.Get(name).GetNumberAsInt();
    const size_t count = locate_elements(document, accessor).count;
    if (poses.empty()) poses.resize(count);
    if (poses.size() != count)
      document.fail(fmt::format("/nodes/{}/extensions/EXT_mesh_gpu_instancing/attributes/{}", index, name),
                    fmt::format("{} values for {} instances", count, poses.size()));
    if (name == "ROTATION") {
      const auto values = read_vectors<Vec4f>(document, accessor);
      for (size_t i = 0; i < count; ++i)
        poses[i].rotation = Imath::Quatd(values[i].w, values[i].x, values[i].y, values[i].z).normalized();
    } else if (name == "TRANSLATION" || name == "SCALE") {
      const auto values = read_vectors<Vec3f>(document, accessor);
      for (size_t i = 0; i < count; ++i)
        (name == "SCALE" ? poses[i].scale : poses[i].translation) = Vec3d(values[i]);
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

std::vector<std::string> variant_names(const Document& document) {
  std::vector<std::string> names;
  const auto extension = document.model().extensions.find("KHR_materials_variants");
  if (extension == document.model().extensions.end()) return names;
  const auto& variants = extension->second.Get("variants");
  for (int i = 0; i < int(variants.ArrayLen()); ++i)
    names.push_back(variants.Get(i).Get("name").Get<std::string>());
  return names;
}

InstancePlacer::InstancePlacer(const Document& document, const std::vector<ImportedMaterial>& materials,
                               const std::string& variant)
    : document_(document), materials_(materials), variant_(find_variant(document, variant)) {}

void InstancePlacer::add_nodes(const NodePlaces& places, const std::vector<NodePose>& poses) {
  // Most have one instance or none; of a million, growing would take as much again for a while.
  result_.instances.reserve(places.shown.size());
  for (const int node : places.shown) add_node(node, places, poses[size_t(node)]);
}

void InstancePlacer::add_node(int index, const NodePlaces& places, const NodePose& pose) {
  const auto& node = document_.nodes()[size_t(index)];
  if (node.mesh < 0) return;
  const auto& mesh = document_.model().meshes[size_t(node.mesh)];
  for (size_t i = 0; i < mesh.primitives.size(); ++i) {
    const auto& primitive = mesh.primitives[i];
    const Topology topology = topology_of(document_, primitive);
    if (topology == Topology::none) {
      ++result_.empty;
      continue;
    }
    const PrimitiveId read = document_.alike_primitives().to_read({node.mesh, int(i)});
    MeshUse use{read.mesh, read.primitive, node.skin, {}};
    if (!primitive.targets.empty()) use.weights = pose.weights.empty() ? mesh.weights : pose.weights;
    InstanceDescription instance;
    instance.name = node.name;
    instance.material = material_of(primitive);
    if (topology != Topology::triangles)
      instance.material = thin_material_of(instance.material, primitive.attributes.count("NORMAL") > 0);
    instance.mesh = mesh_of(request_of(std::move(use), topology, instance.material));
    instance.object = first_object_;
    instance.asset = document_.nodes()[size_t(places.top[size_t(index)])].name;
    // A skinned mesh is where its joints are; its own node does not count (glTF 2.0, 3.7.3.3).
    if (node.skin >= 0)
      result_.instances.push_back(std::move(instance));
    else
      add_instances(index, instance, places.to_world[size_t(index)]);
  }
  if (!result_.instances.empty()) first_object_ = *result_.instances.back().object + 1;
}

void InstancePlacer::add_instances(int node, const InstanceDescription& prototype, const M44d& to_world) {
  const std::string place = fmt::format("/nodes/{}", node);
  const auto& extensions = document_.nodes()[size_t(node)].extensions;
  const auto instancing = extensions.find("EXT_mesh_gpu_instancing");
  const std::vector<M44d> matrices =
      instancing == extensions.end()
          ? std::vector<M44d>{M44d()}
          : instance_matrices(document_, node, instancing->second.Get("attributes"));
  for (uint32_t i = 0; i < matrices.size(); ++i) {
    const auto transform = to_transform(document_, matrices[i] * to_world, place);
    if (!transform) {
      result_.too_far.push_back(prototype.name);
      continue;
    }
    result_.instances.push_back(prototype);
    result_.instances.back().to_world = *transform;
    result_.instances.back().object = first_object_ + i;
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

uint32_t InstancePlacer::thin_material_of(uint32_t material, bool lit) {
  const uint32_t next = uint32_t(materials_.size() + result_.thin_materials.size());
  const auto [found, is_new] = thin_materials_.try_emplace({material, lit}, next);
  if (is_new) {
    result_.thin_materials.push_back(materials_[material]);
    make_thin(result_.thin_materials.back().description, lit);
  }
  return found->second;
}

const ImportedMaterial& InstancePlacer::material_at(uint32_t index) const {
  return index < materials_.size() ? materials_[index] : result_.thin_materials[index - materials_.size()];
}

MeshRequest InstancePlacer::request_of(MeshUse use, Topology topology, uint32_t material) const {
  MeshRequest request;
  request.use = std::move(use);
  request.topology = topology;
  const ImportedMaterial& reader = material_at(material);
  request.tangent_map = tangent_map(reader.description);
  const auto want = [&](const TextureUse& texture) {
    const auto slot = size_t(texture.texcoord);
    if (slot >= request.texcoords.size()) request.texcoords.resize(slot + 1, -1);
    request.texcoords[slot] = reader.texcoord_sets[slot];
  };
  if (request.tangent_map) want(*request.tangent_map);
  for_each_texture(reader.description, [&](const TextureUse& texture) {
    if (texture) want(texture);
  });
  return request;
}

uint32_t InstancePlacer::mesh_of(const MeshRequest& request) {
  const auto [first, last] = meshes_.equal_range(request.use);
  for (auto known = first; known != last; ++known)
    if (reads_the_same(result_.meshes[known->second], request)) return known->second;
  const auto index = uint32_t(result_.meshes.size());
  meshes_.emplace(request.use, index);
  result_.meshes.push_back(request);
  return index;
}

}  // namespace vernier
