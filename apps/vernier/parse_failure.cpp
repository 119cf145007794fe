// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/parse_failure.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/base/names.h"

namespace vernier::apps {
namespace {

/// The subcommand that was being read when parsing failed, innermost.
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().back();
  return *at;
}

std::vector<std::string> flag_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    for (const auto& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({}))
    if (!command->get_group().empty()) names.push_back(command->get_name());
  return names;
}

/// "vernier bench rays"
std::string full_name(const CLI::App& command) {
  std::string name = command.get_name();
  for (const CLI::App* up = command.get_parent(); up; up = up->get_parent())
    name.insert(0, up->get_name() + " ");
  return name;
}

/// What is wrong with the words that nothing on the command line takes.
std::string describe_extras(const CLI::App& app, const std::vector<std::string>& extras) {
  const CLI::App& command = innermost(app);
  const std::string prefix = full_name(command);
  for (const auto& word : extras) {
    if (word.size() < 2 || word[0] != '-') continue;
    const std::string flag = word.substr(0, word.find('='));
    const auto nearest = flag.size() < 4 ? "" : nearest_name(flag, flag_names(command));
    return fmt::format("unknown flag '{}'; {} {} --help", flag,
                       nearest.empty() ? "see" : fmt::format("did you mean '{}'? See", nearest), prefix);
  }
  if (const auto names = subcommand_names(command); !names.empty())
    return unknown_name_message("command", extras.front(), names);
  return fmt::format("'{}' is one argument too many; see {} --help", extras.front(), prefix);
}

}  // namespace

std::string parse_failure(const CLI::App& app, const CLI::ParseError& error) {
  // A misspelt flag is named first: it is often why something else is missing.
  const std::vector<std::string> extras = app.remaining(true);
  const bool flag =
      std::any_of(extras.begin(), extras.end(), [](const auto& w) { return w.size() > 1 && w[0] == '-'; });
  const CLI::App& command = innermost(app);
  const bool no_command = command.get_require_subcommand_min() > 0;
  if (flag || (!extras.empty() && (no_command || dynamic_cast<const CLI::ExtrasError*>(&error))))
    return describe_extras(app, extras);
  if (no_command) return fmt::format("missing COMMAND; see {} --help", full_name(command));
  return error.what();
}

}  // namespace vernier::apps
