// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "apps/vernier/commands.h"
#include "vernier/scene.h"

namespace vernier::apps {

/// Declares --fog on `command`.
void add_fog_flag(CLI::App& command, std::string& fog);

/// What --fog says: DENSITY[,COLOUR[,G[,RADIUS]]]; of density 0 when it was not given. Throws Error(usage).
Fog parse_fog(const std::string& text);

}  // namespace vernier::apps
