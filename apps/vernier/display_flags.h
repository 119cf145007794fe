// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "core/display/display.h"

// How pictures are shown in PNG and JPEG files, as every command that writes such files takes it.

namespace vernier::apps {

/// As far as --exposure goes, up and down.
constexpr double most_stops = 100;

/// --exposure, --view and --ocio.
void add_display_flags(CLI::App& command, DisplayOptions& options);

/// Prints the views when `--view help` was asked for; false: it was not.
bool print_requested_views(const DisplayOptions& options);

}  // namespace vernier::apps
