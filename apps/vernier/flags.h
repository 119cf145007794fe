// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "vernier/error.h"
#include "vernier/scene.h"

// Flags that several subcommands share, and checks of their values.

namespace vernier::apps {

// For CLI::Option::transform, which lets them replace a number by one that CLI11 cannot misread.

/// A finite decimal number from `least` to `most`.
CLI::Validator real_number(double least, double most);

/// A decimal whole number from `least` to `most`.
CLI::Validator whole_number(uint64_t least, uint64_t most);

/// Text that `parse` takes; it throws Error(usage) on any other.
template <typename Parse>
CLI::Validator parsed_by(Parse parse) {
  const auto check = [parse](std::string& text) {
    try {
      parse(text);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  return {check, ""};
}

/// SCENE, and the flags that say how it is read.
void add_scene_flags(CLI::App& command, std::string& scene, ImportOptions& options);
/// The latter alone.
void add_import_flags(CLI::App& command, ImportOptions& options);

/// --threads, for ThreadLimit.
void add_threads_flag(CLI::App& command, unsigned& threads);

/// Throws Error(usage) when one of the files to be written is to be written twice, or is one of those to be
/// read. Empty names are none.
void require_separate_files(const std::vector<std::string>& read, const std::vector<std::string>& written);

/// Throws Error(input) unless `file` is there and may be read. Nothing is opened, for a pipe can be read only
/// once.
void require_readable(const std::string& file);

/// Throws Error(usage) when no scene was given to `command`.
void require_scene(const std::string& scene, const std::string& command);

}  // namespace vernier::apps
