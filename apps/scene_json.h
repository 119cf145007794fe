#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/scene_summary.h"
#include "scene/bounds.h"
#include "scene/description.h"

namespace vernier::apps {

nlohmann::ordered_json material_json(const MaterialDescription& material);

/// Everything that `vernier info` says of a scene (README.md, "What a scene holds").
nlohmann::ordered_json scene_json(const SceneDescription& scene, const SceneCounts& counts,
                                  const Bounds& bounds);

}  // namespace vernier::apps
