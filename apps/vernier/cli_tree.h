// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

// The command line as data, from which the manual, the completions and the launcher's help are written.

namespace vernier::apps {

/// A flag, or an argument without one.
struct CliFlag {
  std::vector<std::string> names;    ///< "-o", "--output"; an argument without a flag has one without dashes
  std::string group;                 ///< heading that the help puts it under
  std::string value;                 ///< what follows it, such as "FILE"; empty when nothing does
  std::string initial;               ///< value when it is not given, as far as the help says it
  std::string description;           ///< one line
  std::vector<std::string> choices;  ///< values that are known by name
  bool takes_file = false;
};

struct CliCommand {
  std::string name;         ///< with those above it: "vernier bench rays"
  std::string description;  ///< one line, without a full stop
  std::string footer;       ///< what is said below the help: the exit codes
  std::string help;         ///< what --help prints
  std::vector<CliFlag> flags, arguments;
  std::vector<CliCommand> commands;
};

/// The tree from `app` down, without what is hidden. `above`: name of the command that it belongs to.
CliCommand cli_tree(const CLI::App& app, const std::string& above = {});

/// Calls visit(command) for `top` and every command below it, from the top.
template <typename Visit>
void for_each_command(const CliCommand& top, const Visit& visit) {
  visit(top);
  for (const CliCommand& command : top.commands) for_each_command(command, visit);
}

/// A manual page in the macros of man(7).
std::string manual_page(const CliCommand& top, const std::string& version);

// Scripts that complete the command line in a shell: names of commands and flags, known values, files.
std::string bash_completion(const CliCommand& top);
std::string zsh_completion(const CliCommand& top);
std::string fish_completion(const CliCommand& top);

/// A C++ initializer, {"vernier bench rays", "HELP"}, for each command.
std::string help_table(const CliCommand& top);

}  // namespace vernier::apps
