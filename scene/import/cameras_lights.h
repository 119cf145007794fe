// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/import/document.h"
#include "scene/import/nodes.h"
#include "vernier/scene.h"

namespace vernier {

/// Adds the cameras and punctual lights of the scene's nodes. A light whose node leaves it no direction is
/// left out with a notice; such a camera has a defect. Throws Error(input).
void add_cameras_and_lights(const Document& document, const NodePlaces& places, SceneDescription& scene);

}  // namespace vernier
