// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/farm/farm_plan.h"
#include "apps/vernier/render_flags.h"

namespace vernier::apps {

/// The flags of `vernier farm slurm`, `sh` and `openjd`, as typed.
struct FarmFlags {
  RenderFlags render;
  std::optional<int> parts;
  std::string folder;  ///< empty: beside the output
  int rounds = 2;
  bool skip_missing = false;
  std::vector<std::string> sbatch;
  bool submit = false;
};

/// Declares the flags on `command`. `is_slurm`: with those for sbatch.
void add_farm_flags(CLI::App& command, FarmFlags& flags, bool is_slurm);

/// What the flags ask for, given to `command`, but for who asked and the program. Throws Error(usage) on what
/// cannot be shared out, and whatever `vernier render` would refuse without reading the scene.
FarmPlan make_farm_plan(const FarmFlags& flags, const CLI::App& command);

}  // namespace vernier::apps
