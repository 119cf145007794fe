// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/import/document.h"
#include "scene/import/materials.h"
#include "scene/import/meshes.h"
#include "scene/import/nodes.h"
#include "vernier/scene.h"

namespace vernier {

/// Names of the file's variants (KHR_materials_variants), in its order.
std::vector<std::string> variant_names(const Document& document);

/// What of the scene there is to see. Instances refer to `meshes` and, by the file's own numbering, to
/// materials, or, beyond those, to `thin_materials`.
struct Placement {
  std::vector<InstanceDescription> instances;
  /// Each primitive once in each shape, however many nodes use it; alike ones once where that spares much.
  std::vector<MeshRequest> meshes;
  std::vector<ImportedMaterial> thin_materials;
  std::vector<std::string> too_far;  ///< names of nodes whose places do not fit in floats, left out
  size_t empty = 0;                  ///< primitives left out: without positions, or with too few
};

/// Makes one instance per node and primitive, times EXT_mesh_gpu_instancing. Throws Error(input).
class InstancePlacer {
 public:
  /// `materials`: all of the file, the default one last. `variant` names one of KHR_materials_variants, or is
  /// empty; throws Error(usage) when there is no such one.
  InstancePlacer(const Document& document, const std::vector<ImportedMaterial>& materials,
                 const std::string& variant);

  /// Those shown of the places.
  void add_nodes(const NodePlaces& places, const std::vector<NodePose>& poses);
  Placement take() { return std::move(result_); }

 private:
  void add_node(int node, const NodePlaces& places, const NodePose& pose);
  void add_instances(int node, const InstanceDescription& prototype, const Imath::M44d& to_world);
  uint32_t material_of(const tinygltf::Primitive& primitive) const;
  /// The material for points and lines, which are shown from all sides, and only lit if they have normals.
  uint32_t thin_material_of(uint32_t material, bool lit);
  const ImportedMaterial& material_at(uint32_t index) const;
  MeshRequest request_of(MeshUse use, Topology topology, uint32_t material) const;
  uint32_t mesh_of(const MeshRequest& request);

  const Document& document_;
  const std::vector<ImportedMaterial>& materials_;
  int variant_ = -1;
  std::multimap<MeshUse, uint32_t> meshes_;  ///< several where alike ones are read differently
  std::map<std::pair<uint32_t, bool>, uint32_t> thin_materials_;  ///< of a material and whether it is lit
  Placement result_;
  uint32_t first_object_ = 0;  ///< number of the next object to be placed
};

}  // namespace vernier
