#pragma once

#include "scene/description.h"
#include "scene/import/document.h"
#include "scene/import/nodes.h"

namespace vernier {

/// Adds the cameras and punctual lights of the scene's nodes. Throws Error(input).
void add_cameras_and_lights(const Document& document, const NodePlaces& places, SceneDescription& scene);

}  // namespace vernier
