// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace vernier::apps {

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
  struct Flag {
    std::string name;
    std::vector<std::string> values;  ///< empty, but given: it takes none
    bool is_given = false;
  };
  std::vector<Flag> flags_;  ///< that pictures depend on, in the order of --help
};

}  // namespace vernier::apps
