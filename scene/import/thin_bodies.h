// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/import/document.h"
#include "scene/import/meshes.h"
#include "vernier/material.h"
#include "vernier/scene.h"

namespace vernier {

// Points and lines have no size in glTF. Here they get a body in the scene, of a radius that follows from the
// extent of all of them.

/// Makes a material one for points or lines: shown from all sides, no boundary of a volume, without what
/// needs tangents. Those that are not lit show the sum of base colour and emission, as those without normals
/// should (glTF 2.0, 3.9.7, Point and Line Materials).
void make_thin(MaterialDescription& material, bool lit);

/// Replaces the points and lines among the scene's meshes, as `requests` tells them, by bodies: points by
/// polyhedra, or, where they have normals, by flat hexagons at right angles to those; lines by prisms with
/// pointed ends. All show as much on average as spheres and round rods of the radius. Throws Error(input)
/// when there are too many.
void add_thin_bodies(const Document& document, const std::vector<MeshRequest>& requests,
                     SceneDescription& scene);

}  // namespace vernier
