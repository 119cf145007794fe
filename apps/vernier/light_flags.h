// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "apps/vernier/commands.h"
#include "integrators/render/layers.h"
#include "vernier/settings.h"

namespace vernier::apps {

/// Declares --light-groups: "NAME=LIGHT,LIGHT", or a LIGHT, which is a group of its own name.
void add_light_groups_flag(CLI::App& command, std::vector<std::string>& groups);

/// What the layers and groups ask to be kept apart. Throws Error(usage) on groups that are none, and on the
/// layer of groups without any.
LightSplit choose_light_split(const std::vector<std::string>& groups, const std::vector<Layer>& layers);

}  // namespace vernier::apps
