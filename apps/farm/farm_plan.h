// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

// What a farm of several machines is to do: parts, each one command that any machine can run, and what is
// done when they are there. Scripts for schedulers are written of it (farm_script.h, openjd.h).

namespace vernier::apps {

/// Parts of one picture, each by a seed of its own.
struct SeedParts {
  uint64_t first_seed = 1;
  int spp = 0;        ///< samples a pixel of all parts together, at first; 0: --time alone ends them
  int most_spp = 0;   ///< that later rounds go on to; 0: no limit
  int rounds = 1;     ///< how often parts and merge follow each other; more than one only with an error
  std::string error;  ///< asked of the merged picture; empty: none
  bool skip_missing = false;
  std::vector<std::string> merge;  ///< words after the parts' names in `vernier merge`
};

/// Parts of an animation: the frames of each, as --frames takes them.
using FrameParts = std::vector<std::string>;

struct FarmPlan {
  std::string command_line;  ///< that asked for it
  std::string vernier;       ///< the program, as the machines find it
  std::string work;          ///< folder in which all commands are run
  std::string folder;        ///< of the parts, from there
  std::string output;        ///< the first; of an animation, with ####
  int parts = 0;
  unsigned threads = 0;             ///< of a part; 0: all that the scheduler gives it
  std::vector<std::string> render;  ///< words after `vernier render` that all parts have
  std::vector<std::string> sbatch;  ///< more options of Slurm's sbatch
  SeedParts seeds;
  FrameParts frames;  ///< empty: the parts are seeds

  bool is_animation() const { return !frames.empty(); }
};

/// What `vernier farm status` reads: farm.json in the folder of the parts.
nlohmann::ordered_json to_json(const FarmPlan& plan);

/// Throws Error(input) when the file is not of this version or lacks something.
FarmPlan read_farm_plan(const std::string& path);

/// Samples a pixel of a part, of those of all parts together.
inline int share(int samples, int part, int parts) { return samples / parts + (part <= samples % parts); }

}  // namespace vernier::apps
