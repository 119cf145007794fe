// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/vernier/cli_tree.h"

// Each script finds the command that is being typed by going through the words, and offers what fits after
// it.

namespace vernier::apps {
namespace {

std::vector<std::string> command_names(const CliCommand& top) {
  std::vector<std::string> names;
  for_each_command(top, [&](const CliCommand& command) { names.push_back(command.name); });
  return names;
}

std::string last_word(const std::string& name) { return name.substr(name.rfind(' ') + 1); }

/// In single quotes, for all three shells.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// "vernier render --spp"|"vernier render -t"
std::string bash_pattern(const CliCommand& command, const std::vector<std::string>& flags) {
  std::vector<std::string> words;
  words.reserve(flags.size());
  for (const auto& flag : flags) words.push_back(fmt::format("\"{} {}\"", command.name, flag));
  return fmt::format("{}", fmt::join(words, "|"));
}

std::string bash_values(const CliCommand& command, const CliFlag& flag) {
  std::string reply;
  if (!flag.choices.empty())
    reply += fmt::format("COMPREPLY+=($(compgen -W \"{}\" -- \"$current\")); ", fmt::join(flag.choices, " "));
  if (flag.takes_file) reply += "COMPREPLY+=($(compgen -f -- \"$current\")); ";
  return fmt::format("    {}) {}return ;;\n", bash_pattern(command, flag.names), reply);
}

/// Flags and commands that can follow.
std::string bash_words(const CliCommand& command) {
  std::vector<std::string> words;
  for (const CliCommand& below : command.commands) words.push_back(last_word(below.name));
  for (const CliFlag& flag : command.flags) words.insert(words.end(), flag.names.begin(), flag.names.end());
  return fmt::format("    \"{}\") words=\"{}\" ;;\n", command.name, fmt::join(words, " "));
}

/// A name that a shell function may have.
std::string function_name(const CliCommand& command) {
  std::string name = "_" + command.name;
  for (char& c : name)
    if (c == ' ') c = '_';
  return name;
}

/// Within the brackets and colons of an argument of _arguments.
std::string zsh_escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += (c == '[' || c == ']' || c == ':' || c == '\\') ? fmt::format("\\{}", c) : std::string(1, c);
  return out;
}

/// ":VALUE:(CHOICES)" or ":VALUE:_files"
std::string zsh_value(const CliFlag& flag) {
  if (flag.value.empty()) return {};
  const std::string choices = flag.choices.empty() ? "" : fmt::format("({})", fmt::join(flag.choices, " "));
  const std::string files = flag.takes_file ? "_files" : "";
  const bool both = !choices.empty() && !files.empty();
  return fmt::format(
      ":{}:{}", zsh_escaped(flag.value),
      both ? fmt::format("_alternative \"words:word:{}\" \"files:file:_files\"", choices) : choices + files);
}

std::string zsh_function(const CliCommand& command) {
  std::string body =
      fmt::format("{}() {{\n  local context state state_descr line\n  local -a commands\n  _arguments -C -S",
                  function_name(command));
  for (const CliFlag& flag : command.flags)
    for (const auto& name : flag.names)
      body +=
          fmt::format(" \\\n    {}",
                      quoted(fmt::format("*{}[{}]{}", name, zsh_escaped(flag.description), zsh_value(flag))));
  if (command.commands.empty()) return body + " \\\n    '*:file:_files'\n}\n";
  body +=
      " \\\n    '1:command:->command' '*::argument:->argument'\n  case $state in\n    command)\n      "
      "commands=(\n";
  for (const CliCommand& below : command.commands)
    body += fmt::format("        {}\n", quoted(last_word(below.name) + ":" + zsh_escaped(below.description)));
  body += "      )\n      _describe command commands ;;\n    argument)\n      case $words[1] in\n";
  for (const CliCommand& below : command.commands)
    body += fmt::format("        {}) {} ;;\n", last_word(below.name), function_name(below));
  return body + "      esac ;;\n  esac\n}\n";
}

std::string fish_flag(const std::string& condition, const CliFlag& flag) {
  std::string line = "complete -c vernier -n " + condition;
  for (const auto& name : flag.names)
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (!flag.value.empty()) line += flag.takes_file ? " -rF" : " -x";
  if (!flag.choices.empty()) line += fmt::format(" -a '{}'", fmt::join(flag.choices, " "));
  return line + " -d " + quoted(flag.description) + '\n';
}

}  // namespace

std::string bash_completion(const CliCommand& top) {
  std::string script =
      "_vernier() {\n  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
      "  local command= words= word\n  COMPREPLY=()\n"
      "  for word in vernier \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n    case \"${command:+$command "
      "}$word\" in\n";
  std::vector<std::string> names;
  for (const auto& name : command_names(top)) names.push_back("\"" + name + "\"");
  script += fmt::format("      {}) command=\"${{command:+$command }}$word\" ;;\n    esac\n  done\n",
                        fmt::join(names, "|"));
  script += "  case \"$command $previous\" in\n";
  for_each_command(top, [&](const CliCommand& command) {
    for (const CliFlag& flag : command.flags)
      if (!flag.value.empty()) script += bash_values(command, flag);
  });
  script += "  esac\n  case \"$command\" in\n";
  for_each_command(top, [&](const CliCommand& command) { script += bash_words(command); });
  return script +
         "  esac\n  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "  [[ $current == -* || ${#COMPREPLY[@]} -gt 0 ]] || COMPREPLY=($(compgen -f -- \"$current\"))\n}\n"
         "complete -o filenames -F _vernier vernier\n";
}

std::string zsh_completion(const CliCommand& top) {
  std::string script = "#compdef vernier\n";
  for_each_command(top, [&](const CliCommand& command) { script += zsh_function(command); });
  return script + "_vernier \"$@\"\n";
}

std::string fish_completion(const CliCommand& top) {
  std::string script =
      "function __vernier_at --argument-names wanted\n    set -l command vernier\n"
      "    for word in (commandline -opc)[2..]\n        switch \"$command $word\"\n            case";
  for (const auto& name : command_names(top)) script += " '" + name + "'";
  script +=
      "\n                set command \"$command $word\"\n        end\n    end\n"
      "    test \"$command\" = \"$wanted\"\nend\n";
  for_each_command(top, [&](const CliCommand& command) {
    const std::string condition = fmt::format("'__vernier_at \"{}\"'", command.name);
    for (const CliCommand& below : command.commands)
      script += fmt::format("complete -c vernier -n {} -f -a {} -d {}\n", condition, last_word(below.name),
                            quoted(below.description));
    for (const CliFlag& flag : command.flags) script += fish_flag(condition, flag);
  });
  return script;
}

}  // namespace vernier::apps
