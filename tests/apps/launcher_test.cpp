// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "apps/launcher/processor.h"
#include "tests/support/process.h"

namespace vernier {
namespace {

using test::run_process;
using test::run_vernier;
using testing::HasSubstr;
using testing::Not;

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class LauncherAnswers : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(LauncherAnswers, AsTheProgramDoes) {
  std::vector<std::string> words{VERNIER_PROGRAM};
  words.insert(words.end(), GetParam().begin(), GetParam().end());
  const auto program = run_process(words), launcher = run_vernier(GetParam());
  EXPECT_EQ(launcher.exit_code, program.exit_code);
  EXPECT_EQ(launcher.out, program.out);
  EXPECT_EQ(launcher.err, program.err);
}

using Words = std::vector<std::string>;
INSTANTIATE_TEST_SUITE_P(CommandLine, LauncherAnswers,
                         testing::Values(Words{"--version"}, Words{"--help"}, Words{"-h"},
                                         Words{"render", "--help"}, Words{"bench", "-h"},
                                         Words{"bench", "rays", "--help"}, Words{},
                                         Words{"render", "--version"}, Words{"rendr", "--help"},
                                         Words{"render", "--spp", "x", "--help"}));

TEST(Launcher, LoadsNoLibraryThatIsSlowToLoad) {
  const std::string file = contents(VERNIER_BINARY);
  EXPECT_THAT(file, HasSubstr("libc.so"));
  for (const char* library : {"libOpenImageIO", "libOpenColorIO", "libembree", "libtbb"})
    EXPECT_EQ(file.find(library), std::string::npos) << library;
}

/// What a program is told of memory that the launcher starts where GLIBC_TUNABLES is as given (null: unset).
std::string tunables_of_program(const char* given) {
  const test::TemporaryFolder folder;
  const std::filesystem::path launcher = folder.file("vernier"), program = folder.file("program/vernier");
  std::filesystem::create_directory(program.parent_path());
  std::filesystem::copy_file(VERNIER_BINARY, launcher);
  std::ofstream(program) << "#!/bin/sh\nprintf %s \"$GLIBC_TUNABLES\"\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::string variable = given ? std::string("GLIBC_TUNABLES=") + given : "-uGLIBC_TUNABLES";
  return run_process({"/usr/bin/env", variable, launcher, "render"}).out;
}

TEST(Launcher, AsksForHugePagesUnlessTold) {
  EXPECT_EQ(tunables_of_program(nullptr), "glibc.malloc.hugetlb=1");
  EXPECT_EQ(tunables_of_program("glibc.malloc.check=0"), "glibc.malloc.check=0:glibc.malloc.hugetlb=1");
  EXPECT_EQ(tunables_of_program("glibc.malloc.hugetlb=0"), "glibc.malloc.hugetlb=0");
}

TEST(Launcher, LevelsHoldThoseBelowThem) {
  bool above = false;
  for (const launcher::Level& level : launcher::levels()) {
    EXPECT_TRUE(level.supported() || !above) << level.name;
    above = level.supported();
  }
  EXPECT_TRUE(launcher::is_supported(launcher::best_level()));
}

/// What bash offers after these words, the last of which is being typed.
std::string completions(const std::string& script, const std::string& words) {
  const std::string typing = "source '" + script + "'; COMP_WORDS=(" + words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _vernier; echo \"${COMPREPLY[*]}\"";
  const auto result = run_process({"/bin/bash", "-c", typing});
  EXPECT_EQ(result.err, "");
  return result.out;
}

TEST(CliFiles, AreWrittenFromTheCommandLine) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(run_vernier({"cli-files", folder.path().string()}).exit_code, 0);
  const std::string bash = folder.file("vernier.bash");
  EXPECT_EQ(completions(bash, "vernier rend"), "render\n");
  EXPECT_EQ(completions(bash, "vernier bench ra"), "rays\n");
  EXPECT_EQ(completions(bash, "vernier render --integrator p"), "path\n");
  EXPECT_EQ(completions(bash, "vernier render x.glb --spp 4 --look-a"), "--look-at\n");
  EXPECT_EQ(completions(bash, "vernier render --spp ''"), "\n");
  EXPECT_EQ(completions(bash, "vernier cli-f"), "\n");
  const std::string manual = contents(folder.file("vernier.1"));
  EXPECT_THAT(manual, HasSubstr("\\fB\\-\\-integrator\\fR \\fINAME\\fR"));
  EXPECT_THAT(manual, HasSubstr(".SS vernier bench rays"));
  EXPECT_THAT(manual, Not(HasSubstr("cli\\-files")));
  EXPECT_THAT(contents(folder.file("_vernier")), HasSubstr("_vernier_bench_rays() {"));
  EXPECT_THAT(contents(folder.file("vernier.fish")),
              HasSubstr("-l integrator -x -a 'path gradient light whitted raycast'"));
}

TEST(CliFiles, NeedAFolder) {
  const auto result = run_vernier({"cli-files", "/missing"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err_lines().size(), 1u);
}

}  // namespace
}  // namespace vernier
