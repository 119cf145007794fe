// SPDX-License-Identifier: Apache-2.0
#include "scene/import/alike_primitives.h"

#include <tuple>
#include <vector>

namespace vernier {
namespace {

using tinygltf::Primitive;

/// Null without.
const tinygltf::Value* draco_of(const Primitive& primitive) {
  const auto found = primitive.extensions.find("KHR_draco_mesh_compression");
  return found == primitive.extensions.end() ? nullptr : &found->second;
}

/// Orders by all that the shape is read from but compressed data.
struct ByAccessors {
  bool operator()(const Primitive* a, const Primitive* b) const {
    return std::tie(a->attributes, a->indices, a->mode, a->targets) <
           std::tie(b->attributes, b->indices, b->mode, b->targets);
  }
};

bool same_compression(const Primitive& a, const Primitive& b) {
  const tinygltf::Value *in_a = draco_of(a), *in_b = draco_of(b);
  return in_a && in_b ? *in_a == *in_b : in_a == in_b;
}

size_t element_count(const tinygltf::Model& model, int accessor) {
  return accessor >= 0 && size_t(accessor) < model.accessors.size() ? model.accessors[size_t(accessor)].count
                                                                    : 0;
}

/// Vertices and indices that a primitive has to be read with.
size_t element_count(const tinygltf::Model& model, const Primitive& primitive) {
  const auto positions = primitive.attributes.find("POSITION");
  return positions == primitive.attributes.end()
             ? 0
             : element_count(model, positions->second) + element_count(model, primitive.indices);
}

}  // namespace

AlikePrimitives::AlikePrimitives(const tinygltf::Model& model) {
  // Together some 50 MB.
  constexpr size_t much = size_t{1} << 20;
  std::map<const Primitive*, std::vector<PrimitiveId>, ByAccessors> groups;
  for (size_t mesh = 0; mesh < model.meshes.size(); ++mesh) {
    const auto& primitives = model.meshes[mesh].primitives;
    for (size_t i = 0; i < primitives.size(); ++i) groups[&primitives[i]].push_back({int(mesh), int(i)});
  }
  for (const auto& [first, members] : groups) {
    if ((members.size() - 1) * element_count(model, *first) <= much) continue;
    for (const PrimitiveId& id : members)
      if (id != members.front() &&
          same_compression(model.meshes[size_t(id.mesh)].primitives[size_t(id.primitive)], *first))
        first_.emplace(id, members.front());
  }
}

PrimitiveId AlikePrimitives::to_read(const PrimitiveId& id) const {
  const auto found = first_.find(id);
  return found == first_.end() ? id : found->second;
}

}  // namespace vernier
