#pragma once

#include <vector>

#include "scene/description.h"
#include "scene/import/document.h"
#include "scene/import/meshes.h"
#include "scene/import/nodes.h"

namespace vernier {

/// What of the scene has a surface. Instances refer to `meshes` and, by the file's own numbering, to
/// materials.
struct Placement {
  std::vector<InstanceDescription> instances;
  std::vector<MeshRequest> meshes;  ///< each mesh primitive once, however many nodes use it
  size_t without_surface = 0;       ///< primitives left out: points, lines, no positions
};

/// One instance per node and primitive of the nodes shown. `materials`: all of the file, the default one
/// last.
Placement place_meshes(const Document& document, const NodePlaces& places,
                       const std::vector<MaterialDescription>& materials);

}  // namespace vernier
