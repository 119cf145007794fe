// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "apps/farm/farm_plan.h"

namespace vernier::apps {

/// A bash script that runs all of a plan on this machine or, by GNU parallel, on several.
std::string shell_script(const FarmPlan& plan);

/// A bash script that submits itself to Slurm.
std::string slurm_script(const FarmPlan& plan);

/// A template for Open Job Description, version jobtemplate-2023-09, as JSON. Throws Error(usage) on what it
/// cannot say.
std::string openjd_template(const FarmPlan& plan);

}  // namespace vernier::apps
