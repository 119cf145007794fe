// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/export.h"
#include "vernier/scene.h"

namespace vernier {

/// Whether a scene can be built within the limit, beside what the process has: an estimate. Textures are not
/// what is refused, as they can be left in a file. Throws Error(memory).
VERNIER_API void check_scene_size(const SceneDescription& scene, const MemoryLimit& limit);

}  // namespace vernier
