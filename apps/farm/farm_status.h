// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vernier::apps {

/// How far the parts in a folder are, by what is in their files, as lines of text. Throws Error(input) when
/// it is no folder of a farm.
std::string farm_status(const std::string& folder);

}  // namespace vernier::apps
