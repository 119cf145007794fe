// SPDX-License-Identifier: Apache-2.0
#include "scene/import/vertex_arrays.h"

namespace vernier {
namespace {

template <typename V>
void gather(std::vector<V>& values, const std::vector<uint32_t>& sources) {
  if (values.empty()) return;
  std::vector<V> gathered;
  gathered.reserve(sources.size());
  for (const uint32_t source : sources) gathered.push_back(values[source]);
  values = std::move(gathered);
}

}  // namespace

void gather_vertices(MeshDescription& mesh, const std::vector<uint32_t>& sources) {
  gather(mesh.positions, sources);
  gather(mesh.normals, sources);
  gather(mesh.tangents, sources);
  for (size_t set = 0; set < mesh.texcoord_set_count(); ++set) gather(mesh.texcoord_set(set), sources);
  gather(mesh.colors, sources);
}

void unshare_vertices(MeshDescription& mesh) {
  std::vector<uint32_t> sources;
  sources.reserve(mesh.triangles.size() * 3);
  for (auto& triangle : mesh.triangles)
    for (uint32_t& index : triangle) {
      sources.push_back(index);
      index = uint32_t(sources.size() - 1);
    }
  gather_vertices(mesh, sources);
}

void drop_unused_vertices(MeshDescription& mesh) {
  if (mesh.triangles.size() * 3 >= mesh.positions.size()) return;
  constexpr uint32_t unused = ~0u;
  std::vector<uint32_t> numbers(mesh.positions.size(), unused), sources;
  for (auto& triangle : mesh.triangles)
    for (uint32_t& index : triangle) {
      if (numbers[index] == unused) {
        numbers[index] = uint32_t(sources.size());
        sources.push_back(index);
      }
      index = numbers[index];
    }
  gather_vertices(mesh, sources);
}

}  // namespace vernier
