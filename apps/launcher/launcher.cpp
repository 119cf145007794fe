// SPDX-License-Identifier: Apache-2.0
// The command `vernier`. It becomes the program built for the highest level of processor that this machine
// has, and answers --version and --help itself: loading the program's libraries takes a third of a second,
// most of it for those that OpenImageIO brings. It is compiled for any processor and links nothing but the
// C++ library. What must be known before a program begins is said here too: how it gets its memory.

#include <sys/auxv.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "apps/launcher/processor.h"

namespace vernier::launcher {
namespace {

/// As env(1) and the shells have it for a program that is there and cannot be run.
constexpr int exit_cannot_run = 126;

struct Help {
  std::string_view command, text;
};
constexpr Help helps[] = {
#include "help_table.inc"
};

/// Answers "vernier --version" and "vernier [COMMAND]... --help". All else is the program's to read.
bool answered(int argc, char** argv) {
  if (argc < 2) return false;
  const std::string_view last = argv[argc - 1];
  if (argc == 2 && last == "--version") {
    std::puts("vernier " VERNIER_VERSION);
    return true;
  }
  if (last != "--help" && last != "-h") return false;
  std::string command = "vernier";
  for (int i = 1; i + 1 < argc; ++i) command.append(" ").append(argv[i]);
  for (const Help& help : helps) {
    if (help.command != command) continue;
    std::fwrite(help.text.data(), 1, help.text.size(), stdout);
    return true;
  }
  return false;
}

/// Asks glibc (2.35 and later) for huge pages. Rays jump about in meshes, textures and surroundings, and with
/// pages of 4 kB many a jump waits for the page table first: 6 to 12 % of the time of real scenes
/// (docs/speed.md). No memory is taken that would not be otherwise. What the user says of it stands.
void ask_for_huge_pages() {
  constexpr const char* variable = "GLIBC_TUNABLES";
  constexpr std::string_view tunable = "glibc.malloc.hugetlb";
  std::string tunables;
  if (const char* given = std::getenv(variable)) tunables = given;
  if (tunables.find(tunable) != std::string::npos) return;
  if (!tunables.empty()) tunables += ':';
  setenv(variable, tunables.append(tunable).append("=1").c_str(), 1);
}

int become(const std::string& program, char** argv) {
  ask_for_huge_pages();
  execv(program.c_str(), argv);
  std::fprintf(stderr, "error: %s: %s\n", program.c_str(), std::strerror(errno));
  return exit_cannot_run;
}

int refuse(const char* level) {
  std::fprintf(
      stderr,
      "error: this processor lacks instructions of %s, which this build of Vernier needs at least; build it "
      "with -DVERNIER_MARCH=%s\n",
      level, best_level());
  return exit_cannot_run;
}

/// Where this program is: by /proc, or where that is not mounted, by the name that the kernel was given to
/// run.
std::filesystem::path own_file() {
  std::error_code error;
  auto file = std::filesystem::read_symlink("/proc/self/exe", error);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): so the kernel gives it
  const auto* name = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  return error && name ? std::filesystem::canonical(name, error) : file;
}

int run(char** argv) {
  std::error_code error;
  const auto folder = own_file().parent_path();
  // In a build folder there is one program, whatever was built there before.
  if (const auto built = folder / "program" / "vernier"; std::filesystem::exists(built, error))
    return is_supported(VERNIER_LEVEL) ? become(built, argv) : refuse(VERNIER_LEVEL);
  const auto programs = (folder / VERNIER_PROGRAM_FOLDER).lexically_normal();
  const char* lacking = nullptr;
  for (const Level& level : levels()) {
    const auto program = programs / level.name / "vernier";
    if (!std::filesystem::exists(program, error)) continue;
    if (level.supported()) return become(program, argv);
    lacking = level.name;
  }
  if (lacking) return refuse(lacking);
  std::fprintf(stderr, "error: %s: no program is there; install Vernier again\n", programs.c_str());
  return exit_cannot_run;
}

}  // namespace
}  // namespace vernier::launcher

int main(int argc, char** argv) {
  if (vernier::launcher::answered(argc, argv)) return std::fflush(stdout) == 0 ? 0 : 3;
  return vernier::launcher::run(argv);
}
