// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "vernier/error.h"

// The `vernier` program is main.cpp and one file a subcommand. A subcommand is added by writing its file,
// declaring its registration function here and listing it in main.cpp.

namespace vernier::apps {

/// What the process returns (README.md, "Exit codes").
enum class ExitCode {
  done = 0,
  comparison_failed = 1,
  usage = 2,
  input = 3,   ///< a scene or file that cannot be read or written
  memory = 4,  ///< out of memory
  stopped = 5  ///< interrupted; the image so far is written
};

/// Of a process that an error of that kind ends.
ExitCode exit_code(ErrorKind kind);

/// The program while its command line is read.
struct Program {
  CLI::App app;
  std::string name;                ///< by which it was called: a path, or what was found in $PATH
  std::string command_line;        ///< as typed, quoted where the shell needs it
  std::vector<std::string> words;  ///< of the command line but the first, as typed
  std::function<ExitCode()> run;   ///< set by the chosen subcommand's callback; may throw vernier::Error
};

// Each adds one subcommand to `program.app`, with a callback that sets `program.run`:
//   auto* command = program.app.add_subcommand("info", "Say what a scene holds");
//   auto options = std::make_shared<InfoOptions>();
//   command->add_option("SCENE", options->scene, "glTF file (.gltf, .glb)");
//   command->callback([&program, options] { program.run = [options] { return run_info(*options); }; });
// A misuse found by the callback or by `run` is Error(usage).
void register_render(Program& program);
void register_info(Program& program);
void register_verify(Program& program);
void register_compare(Program& program);
void register_denoise(Program& program);
void register_develop(Program& program);
void register_gallery(Program& program);
void register_farm(Program& program);
void register_merge(Program& program);
void register_serve(Program& program);
void register_bench(Program& program);
void register_cli_files(Program& program);

}  // namespace vernier::apps
