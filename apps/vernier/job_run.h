// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "apps/vernier/render_flags.h"

namespace vernier::apps {

/// Renders what a list of jobs says, one after the other; each is a command line that begins with `words`,
/// those that `vernier render` was given beside the list. All are read and checked before the first is
/// rendered. Throws Error, with the line of the list, on the first that fails, unless the run is to go on.
ExitCode run_jobs(const RenderFlags& flags, const std::vector<std::string>& words);

}  // namespace vernier::apps
