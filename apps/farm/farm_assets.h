// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

// Parts of the scripts that farms run, compiled into the program by CMake.

namespace vernier::apps::farm_assets {

extern const std::string_view common_sh;  ///< apps/farm/common.sh
extern const std::string_view seeds_sh;   ///< apps/farm/seeds.sh
extern const std::string_view frames_sh;  ///< apps/farm/frames.sh
extern const std::string_view sh_sh;      ///< apps/farm/sh.sh
extern const std::string_view slurm_sh;   ///< apps/farm/slurm.sh
extern const std::string_view openjd_sh;  ///< apps/farm/openjd.sh

}  // namespace vernier::apps::farm_assets
