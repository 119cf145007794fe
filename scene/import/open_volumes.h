#pragma once

#include <vector>

#include "scene/description.h"
#include "scene/import/materials.h"
#include "scene/import/meshes.h"

namespace vernier {

/// Warns of each mesh whose volume has no inside since its surface has an edge (KHR_materials_volume: "the
/// mesh must be closed"). Primitives of one mesh close each other. `requests` are those of the scene's
/// meshes; the scene's instances still number materials by the file.
void notice_open_volumes(const std::vector<MeshRequest>& requests,
                         const std::vector<ImportedMaterial>& materials, SceneDescription& scene);

}  // namespace vernier
