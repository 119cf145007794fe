// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include "apps/vernier/cli_tree.h"
#include "apps/vernier/commands.h"
#include "core/base/atomic_file.h"
#include "vernier/version.h"

namespace vernier::apps {
namespace {

ExitCode write_cli_files(const CLI::App& app, const std::string& folder) {
  const CliCommand top = cli_tree(app);
  const std::filesystem::path path(folder);
  write_file(path / "vernier.1", manual_page(top, version()));
  write_file(path / "vernier.bash", bash_completion(top));
  write_file(path / "_vernier", zsh_completion(top));
  write_file(path / "vernier.fish", fish_completion(top));
  write_file(path / "help_table.inc", help_table(top));
  return ExitCode::done;
}

}  // namespace

void register_cli_files(Program& program) {
  CLI::App* command = program.app.add_subcommand(
      "cli-files",
      "Write the manual page, the completions and the launcher's help, from the command line itself");
  command->group("");  // part of the build, not of what users are told
  auto folder = std::make_shared<std::string>();
  command->add_option("DIR", *folder, "where to write them")->required();
  command->callback([&program, folder] {
    program.run = [&program, folder] { return write_cli_files(program.app, *folder); };
  });
}

}  // namespace vernier::apps
