// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/vernier/commands.h"
#include "apps/vernier/shutter_flags.h"

namespace vernier::apps {

/// Which pictures a run of `vernier render` makes, and how it goes about it, as typed.
struct RunFlags {
  std::vector<std::string> scenes;
  std::string jobs;           ///< a list of command lines, each a run of its own; empty: none
  std::string frames;         ///< empty: none
  std::optional<double> fps;  ///< none: 24
  std::optional<int> turntable;
  ShutterFlags shutter;
  bool skip_existing = false, keep_going = false, draft = false;
  std::string write_every;  ///< a time, or "never"; empty: every two seconds on a terminal
  std::string format;       ///< of the picture on standard output; empty: png
};

/// Declares the flags on `command`, but for the scenes.
void add_run_flags(CLI::App& command, RunFlags& flags);

/// Declares --jobs.
void add_jobs_flag(CLI::App& command, RunFlags& flags);

/// Declares what is done soon: --draft, --write-every, --format.
void add_preview_flags(CLI::App& command, RunFlags& flags);

/// What else is asked for: a time by --at, and how things move between pictures.
struct TimeFlags {
  bool time_is_given = false, shows_motion = false;
};

/// Throws Error(usage) on flags that mean nothing beside each other.
void check_run_flags(const RunFlags& flags, const TimeFlags& others);

/// Seconds between pictures of a render that is not done yet; none: there are none. `on_terminal`: somebody
/// is watching.
std::optional<double> preview_interval(const RunFlags& flags, bool on_terminal);

}  // namespace vernier::apps
