// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "scene/lights/light_node.h"
#include "scene/lights/light_split.h"

namespace vernier {

/// The nodes of a tree over the lights, which are moved about, on all threads; each node before those below
/// it. At least one light; all have power.
std::vector<LightNode> build_light_nodes(std::span<PlacedLight> lights);

}  // namespace vernier
