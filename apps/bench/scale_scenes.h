// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "vernier/scene.h"

namespace vernier::apps {

/// A hilly ground of about so many triangles, lit by the sky.
SceneDescription scene_of_triangles(size_t triangles);
/// So many copies of a hill of 100,000 triangles, each turned its own way.
SceneDescription scene_of_instances(size_t instances);
/// So many glowing triangles, no two of which make a parallelogram, above a ground.
SceneDescription scene_of_lights(size_t lights);

}  // namespace vernier::apps
