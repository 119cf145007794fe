// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

#include "apps/vernier/commands.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/parse_failure.h"
#include "apps/vernier/stop_signals.h"
#include "vernier/error.h"
#include "vernier/version.h"

namespace vernier::apps {
namespace {

/// Every subcommand, in the order of `vernier --help`.
constexpr void (*subcommands[])(Program&) = {
    register_render,  register_info,    register_verify, register_compare,
    register_denoise, register_develop, register_merge,  register_gallery,
    register_farm,    register_serve,   register_bench,  register_cli_files,
};

ExitCode parse_failed(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    app.exit(error);  // prints the help or the version that was asked for
    return ExitCode::done;
  }
  print_error(parse_failure(app, error));
  return ExitCode::usage;
}

/// Whether `render --progress json` is asked for. That must be known before the flags are read: what is wrong
/// with them is said in JSON too.
bool asks_for_json(std::span<const char* const> words) {
  if (words.size() < 2 || words[1] != std::string_view("render")) return false;
  for (size_t i = 2; i < words.size(); ++i)
    if (words[i] == std::string_view("--progress=json") ||
        (words[i] == std::string_view("json") && words[i - 1] == std::string_view("--progress")))
      return true;
  return false;
}

ExitCode run_program(int argc, char** argv) {
  Program program;
  program.name = argv[0];
  const std::span<const char* const> words(argv, static_cast<size_t>(argc));
  program.words.assign(words.begin() + (words.empty() ? 0 : 1), words.end());
  program.command_line = shell_quoted(words);
  if (asks_for_json(words)) speak_json({{"vernier", version()}, {"command", program.command_line}});
  program.app.name("vernier");
  program.app.description("CPU renderer for glTF 2.0 scenes.");
  program.app.footer(
      "Exit codes: 0 done, 1 comparison failed, 2 usage, 3 bad scene or file, 4 out of memory,\n"
      "5 stopped early (image written).");
  program.app.set_version_flag("--version", fmt::format("vernier {}", version()));
  program.app.require_subcommand(1);
  for (const auto add : subcommands) add(program);
  try {
    program.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return parse_failed(program.app, error);
  }
  return program.run();
}

}  // namespace

ExitCode exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return ExitCode::usage;
    case ErrorKind::memory:
      return ExitCode::memory;
    case ErrorKind::input:
    case ErrorKind::output:
      break;
  }
  return ExitCode::input;
}

}  // namespace vernier::apps

int main(int argc, char** argv) {
  using namespace vernier;
  using namespace vernier::apps;
  const auto start = std::chrono::steady_clock::now();
  install_cleanup_signals();
  ExitCode code = ExitCode::done;
  try {
    code = run_program(argc, argv);
  } catch (const Error& error) {
    print_error(error.what());
    code = exit_code(error.kind());
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
    code = ExitCode::memory;
  } catch (const std::length_error&) {  // a container asked for more than can be addressed
    print_error("out of memory");
    code = ExitCode::memory;
  } catch (const std::exception& error) {
    print_error(fmt::format("unexpected: {}", error.what()));
    code = ExitCode::input;
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  print_event({{"event", "finished"}, {"exit_code", static_cast<int>(code)}, {"seconds", elapsed.count()}});
  return static_cast<int>(code);
}
