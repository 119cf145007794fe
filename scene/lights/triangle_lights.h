// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "scene/lights/triangle_light.h"

namespace vernier {

/// All emissive triangles of a scene.
struct TriangleLights {
  std::vector<std::unique_ptr<EmissiveMesh>> meshes;  ///< what `lights` refer to
  std::vector<TriangleLight> lights;                  ///< by instance and triangle
  /// By instance and triangle: which of `lights` it is, or belongs to; -1: none. Empty for instances without
  /// any.
  std::vector<std::vector<int32_t>> of_triangle;
};

/// `materials` by the number that `material_of_instance` gives. Both they and the geometry must live as long.
TriangleLights collect_triangle_lights(const SceneGeometry& geometry, std::span<const Material> materials,
                                       std::span<const uint32_t> material_of_instance);

}  // namespace vernier
