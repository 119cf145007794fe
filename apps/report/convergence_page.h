// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/bench/convergence.h"

namespace vernier::apps {

/// The page of `vernier bench convergence`: `report` (docs/bench.md) for people, with pictures. `report`
/// itself is in it, under the id "convergence".
std::string convergence_page(const nlohmann::ordered_json& report,
                             const std::vector<SceneConvergence>& scenes);

}  // namespace vernier::apps
