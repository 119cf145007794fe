// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace vernier::apps {

/// A flag of a command, and whether and how it was given.
struct CommandFlag {
  std::string name;                 ///< the first long one
  std::vector<std::string> values;  ///< empty, but given: it takes none
  bool is_given = false;
};

/// All of a command that has been parsed, in the order of --help, but for arguments without a flag.
std::vector<CommandFlag> flags_of(const CLI::App& command);

/// What of a `vernier render` command a picture depends on, for its header: a command that makes this picture
/// alone. So a frame has the same bytes as when it is rendered by itself, to any file and on any number of
/// threads.
class PictureCommand {
 public:
  /// Reads what was given to `render`, once it is parsed.
  explicit PictureCommand(const CLI::App& render);

  /// The command for a picture of `scene`, with these flags in place of what was given; an empty value leaves
  /// a flag out.
  std::string text(const std::string& scene, const std::map<std::string, std::string>& instead) const;
  /// The same as words, "vernier" first.
  std::vector<std::string> words(const std::string& scene,
                                 const std::map<std::string, std::string>& instead) const;
  /// What was given to a flag; empty where it was not, or takes nothing.
  std::string value(const std::string& flag) const;

 private:
  std::vector<CommandFlag> flags_;
};

}  // namespace vernier::apps
