// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/cli_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>

#include "core/denoise/denoise.h"
#include "integrators/integrator.h"
#include "integrators/render/layers.h"
#include "scene/accel/accelerator.h"
#include "scene/lights/built_in_environment.h"

namespace vernier::apps {
namespace {

template <typename Table>
std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  names.reserve(std::size(table));
  for (const auto& entry : table) names.emplace_back(entry.name);
  return names;
}

/// What the flags take that have a list of their own.
const std::vector<std::string>& listed_values(const std::string& flag) {
  static const std::map<std::string, std::vector<std::string>> values = {
      {"--integrator", names_of(integrators())},
      {"--accelerator", names_of(accelerators())},
      {"--denoise", denoiser_names()},
      {"--filter", denoiser_names()},
      {"--env", names_of(built_in_environments())},
      {"--aov", names_of(layers())},
      {"--show", {raycast_outputs().begin(), raycast_outputs().end()}},
  };
  static const std::vector<std::string> none;
  const auto found = values.find(flag);
  return found == values.end() ? none : found->second;
}

/// The words among the alternatives of "NAME|N|all" that stand for themselves, which are those in small
/// letters.
std::vector<std::string> literal_words(const std::string& value) {
  std::vector<std::string> words;
  std::istringstream alternatives(value);
  for (std::string word; std::getline(alternatives, word, '|');)
    if (!word.empty() &&
        std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::islower(c); }))
      words.push_back(word);
  return words;
}

CliFlag cli_flag(const CLI::Option& option) {
  CliFlag flag;
  for (const auto& name : option.get_snames()) flag.names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) flag.names.push_back("--" + name);
  if (flag.names.empty()) flag.names.push_back(option.get_name());
  flag.group = option.get_group();
  flag.description = option.get_description();
  if (option.get_type_size() == 0) return flag;
  const std::string type = option.get_type_name();
  flag.value = type.substr(0, type.find(":{"));  // CLI11 appends what it checks the value against
  flag.initial = option.get_default_str();
  flag.choices = literal_words(flag.value);
  for (const auto& name : flag.names)
    flag.choices.insert(flag.choices.end(), listed_values(name).begin(), listed_values(name).end());
  const bool argument = !flag.names.front().starts_with('-');
  flag.takes_file =
      argument || flag.value.find("FILE") != std::string::npos || flag.value.find("DIR") != std::string::npos;
  return flag;
}

}  // namespace

CliCommand cli_tree(const CLI::App& app, const std::string& above) {
  CliCommand command;
  command.name = above.empty() ? app.get_name() : above + " " + app.get_name();
  command.description = app.get_description();
  if (command.description.ends_with('.')) command.description.pop_back();
  command.footer = app.get_footer();
  // help() itself would answer for the command that was parsed.
  command.help = app.get_formatter()->make_help(&app, command.name, CLI::AppFormatMode::Normal);
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty())
      (option->nonpositional() ? command.flags : command.arguments).push_back(cli_flag(*option));
  for (const CLI::App* below : app.get_subcommands({}))
    if (!below->get_group().empty()) command.commands.push_back(cli_tree(*below, command.name));
  return command;
}

std::string help_table(const CliCommand& top) {
  std::string table;
  for_each_command(top, [&](const CliCommand& command) {
    table += fmt::format("{{\"{}\", R\"help({})help\"}},\n", command.name, command.help);
  });
  return table;
}

}  // namespace vernier::apps
