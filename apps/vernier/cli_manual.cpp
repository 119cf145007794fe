// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/vernier/cli_tree.h"

namespace vernier::apps {
namespace {

/// Text as roff takes it: backslashes and dashes are themselves, and no line begins with a control character.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
      out += fmt::format("\\&{}", c);
    else
      out += c;
  }
  return out;
}

std::string flag_entry(const CliFlag& flag) {
  std::string names;
  for (const auto& name : flag.names)
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", roff(name));
  std::string entry = ".TP\n" + names;
  if (!flag.value.empty() && flag.names.front().starts_with('-'))
    entry += fmt::format(" \\fI{}\\fR", roff(flag.value));
  entry += '\n' + roff(flag.description);
  if (!flag.initial.empty()) entry += fmt::format(" [{}]", roff(flag.initial));
  return entry + '\n';
}

std::string command_section(const CliCommand& command) {
  std::string usage = fmt::format(".SS {}\n{}.\n", roff(command.name), roff(command.description));
  for (const CliFlag& argument : command.arguments) usage += flag_entry(argument);
  std::string group;
  for (const CliFlag& flag : command.flags) {
    if (flag.group != group && flag.group != "Options")
      usage += fmt::format(".PP\n\\fI{}\\fR\n", roff(flag.group));
    group = flag.group;
    usage += flag_entry(flag);
  }
  return usage;
}

}  // namespace

std::string manual_page(const CliCommand& top, const std::string& version) {
  std::string page =
      fmt::format(".TH VERNIER 1 \"\" \"vernier {0}\" \"User Commands\"\n.SH NAME\nvernier \\- {1}\n",
                  roff(version), roff(top.description));
  page += ".SH SYNOPSIS\n";
  for_each_command(top, [&](const CliCommand& command) {
    if (!command.commands.empty()) return;
    page += fmt::format("\\fB{}\\fR [\\fIOPTION\\fR]...", roff(command.name));
    for (const CliFlag& argument : command.arguments)
      page += fmt::format(" [\\fI{}\\fR]", roff(argument.names.front()));
    page += "\n.br\n";
  });
  page += ".SH COMMANDS\n";
  for_each_command(top, [&](const CliCommand& command) { page += command_section(command); });
  page += ".SH EXIT STATUS\n" + roff(top.footer) + '\n';
  return page +
         ".SH ENVIRONMENT\n.TP\n\\fBOCIO\\fR\nOpenColorIO config, where \\fB\\-\\-ocio\\fR gives none.\n";
}

}  // namespace vernier::apps
