// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "apps/vernier/scene_summary.h"
#include "scene/bounds.h"
#include "vernier/scene.h"

namespace vernier::apps {

/// The shortest decimal that is this value as a float; JSON has no infinity, so null stands for it.
nlohmann::ordered_json number_json(double value);

template <typename Vector>
nlohmann::ordered_json vector_json(const Vector& v) {
  auto list = nlohmann::ordered_json::array();
  for (int i = 0; i < int(Vector::dimensions()); ++i) list.push_back(number_json(v[i]));
  return list;
}

nlohmann::ordered_json material_json(const MaterialDescription& material);

/// Names, how each is honoured, and notes.
nlohmann::ordered_json features_json(const std::vector<FeatureUse>& features);

/// Everything that `vernier info` says of a scene (README.md, "What a scene holds").
/// but for `bounds` and `render`, which are null.
nlohmann::ordered_json scene_json(const SceneDescription& scene, const SceneCounts& counts);

/// Null where they are empty.
nlohmann::ordered_json bounds_json(const Bounds& bounds);

}  // namespace vernier::apps
