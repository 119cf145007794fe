// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/picture_command.h"

#include <set>

#include "apps/vernier/messages.h"

namespace vernier::apps {
namespace {

/// Flags that say where pictures go, which of them are made, and what is said meanwhile.
const std::set<std::string> not_of_the_picture{
    "--output", "--format",      "--stats",      "--report",  "--checkpoint",    "--checkpoint-every",
    "--resume", "--progress",    "--quiet",      "--verbose", "--threads",       "--frames",
    "--fps",    "--write-every", "--keep-going", "--help",    "--skip-existing", "--drop-checkpoint",
    "--host",   "--port",        "--jobs"};

}  // namespace

std::vector<CommandFlag> flags_of(const CLI::App& command) {
  std::vector<CommandFlag> flags;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_lnames().empty()) continue;
    CommandFlag flag{"--" + option->get_lnames().front(), {}, option->count() > 0};
    const bool takes_value = option->get_items_expected_max() > 0;
    if (flag.is_given && takes_value)
      for (const std::string& value : option->reduced_results())
        if (!value.empty()) flag.values.push_back(value);
    flags.push_back(std::move(flag));
  }
  return flags;
}

PictureCommand::PictureCommand(const CLI::App& render) : flags_(flags_of(render)) {}

std::vector<std::string> PictureCommand::words(const std::string& scene,
                                               const std::map<std::string, std::string>& instead) const {
  std::vector<std::string> words{"vernier", "render", scene};
  for (const CommandFlag& flag : flags_) {
    const auto other = instead.find(flag.name);
    if (other == instead.end() ? !flag.is_given || not_of_the_picture.contains(flag.name)
                               : other->second.empty())
      continue;
    words.push_back(flag.name);
    if (other != instead.end())
      words.push_back(other->second);
    else
      words.insert(words.end(), flag.values.begin(), flag.values.end());
  }
  return words;
}

std::string PictureCommand::value(const std::string& flag) const {
  for (const CommandFlag& given : flags_)
    if (given.name == flag && !given.values.empty()) return given.values.front();
  return {};
}

std::string PictureCommand::text(const std::string& scene,
                                 const std::map<std::string, std::string>& instead) const {
  return shell_quoted(words(scene, instead));
}

}  // namespace vernier::apps
