#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "scene/import/import.h"

// Flags that several subcommands share, and checks of their values.

namespace vernier::apps {

/// A finite number from `least` to `most`.
CLI::Validator real_number(double least, double most);

/// A whole number from `least` to `most`.
CLI::Validator whole_number(int least, int most);

/// SCENE, and the flags that say how it is read.
void add_scene_flags(CLI::App& command, std::string& scene, ImportOptions& options);

/// Throws Error(usage) when no scene was given to `command`.
void require_scene(const std::string& scene, const std::string& command);

}  // namespace vernier::apps
