// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"

namespace vernier {
namespace {

using test::cornell_box;
using test::ProcessResult;
using test::run_vernier;
using testing::HasSubstr;
using testing::StartsWith;

/// One line on standard error that has `text`, nothing on standard output.
void expect_refused(const ProcessResult& result, int exit_code, const std::string& text) {
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
  EXPECT_THAT(result.err, StartsWith("error: "));
  EXPECT_THAT(result.err, HasSubstr(text));
  EXPECT_EQ(result.out, "");
}

struct Misuse {
  std::vector<std::string> arguments;  ///< after "render SCENE -o FOLDER/out.exr"
  int exit_code;
  std::string text;
};

class RenderMisuse : public testing::TestWithParam<Misuse> {};

TEST_P(RenderMisuse, IsOneClearLineAndWritesNothing) {
  const test::TemporaryFolder folder;
  std::vector<std::string> arguments{"render", cornell_box, "-o", folder.file("out.exr")};
  for (const std::string& argument : GetParam().arguments)
    arguments.push_back(argument.find('/') == 0 ? folder.path().string() + argument : argument);
  expect_refused(run_vernier(arguments), GetParam().exit_code, GetParam().text);
  EXPECT_TRUE(folder.names().empty());
}

// A leading slash stands for the test's own folder.
INSTANTIATE_TEST_SUITE_P(
    CommandLine, RenderMisuse,
    testing::Values(
        Misuse{{"--sppp", "4"}, 2, "unknown flag '--sppp'; did you mean '--spp'? See vernier render --help"},
        Misuse{{"--integrater=path"}, 2, "did you mean '--integrator'?"},
        Misuse{{"-x"}, 2, "unknown flag '-x'; see vernier render --help"},
        Misuse{{"another.glb"}, 2, "2 scenes would be written over each other; put {name} into the name"},
        Misuse{{"--spp"}, 2, "--spp"}, Misuse{{"--spp", "0"}, 2, "--spp: '0' is not a whole number from 1"},
        Misuse{{"--spp", "many"}, 2, "--spp: 'many' is not a whole number"},
        Misuse{{"--seed", "-1"}, 2, "--seed: '-1'"}, Misuse{{"--threads", "-2"}, 2, "--threads: '-2'"},
        Misuse{{"--max-depth", "0"}, 2, "--max-depth: '0'"},
        Misuse{{"--time", "soon"}, 2, "--time: 'soon' is not a duration"},
        Misuse{{"--time", "0s"}, 2, "--time: '0s'"},
        Misuse{{"--size", "0x64"}, 2, "--size: '0x64' is not a size"},
        Misuse{{"--resolution", "64"}, 2, "--size: '64' is not a size"},
        Misuse{{"--crop", "8x8"}, 2, "--crop: '8x8' is not a part of the picture"},
        Misuse{{"--size", "10x10", "--crop", "8x8+4+0"}, 2, "reaches beyond the picture of 10x10"},
        Misuse{{"--exposure", "nan"}, 2, "--exposure: 'nan' is not a number"},
        Misuse{{"--integrator", "pth"}, 2, "unknown integrator 'pth'; did you mean 'path'?"},
        Misuse{{"--integrator", "raycast", "--show", "normals"}, 2, "did you mean 'normal'?"},
        Misuse{{"--show", "depth"}, 2, "--show needs --integrator raycast"},
        Misuse{{"--accelerator", "embre"}, 2, "unknown accelerator 'embre'; did you mean 'embree'?"},
        Misuse{{"--view", "AECS SDR"}, 2, "did you mean 'ACES SDR'?"},
        Misuse{{"--progress", "pie"}, 2, "unknown --progress 'pie'"},
        Misuse{{"--camera", "back"}, 2, "unknown camera 'back'"}, Misuse{{"--camera", "1"}, 2, "0 (front)"},
        Misuse{{"--env-scale", "2"}, 2, "need --env studio, sky or FILE"},
        Misuse{{"--env", "/missing.hdr"}, 3, "missing.hdr"},
        Misuse{{"--ocio", "/missing.ocio"}, 3, "missing.ocio"},
        Misuse{{"-o", "/picture.gif"}, 3, "picture.gif"},
        Misuse{{"-o", "/missing/picture.png"}, 3, "missing/picture.png"}, Misuse{{"-o", "/"}, 3, ""},
        Misuse{{"--stats", "/missing/stats.json"}, 3, "missing/stats.json"},
        Misuse{{"--error", "2"}, 2, "--error: '2' is not a part of the whole, above 0 and below 1"},
        Misuse{{"--aov", "error,,id"}, 2, "unknown layer ''; there are: error"},
        Misuse{{"-o", "/a.png", "-o", "/./a.png"}, 2, "a.png: is named for two outputs"},
        Misuse{{"--report", "/out.exr"}, 2, "out.exr: is named for two outputs"},
        Misuse{{"--size", "65536x65536"}, 4, "of memory"}));

TEST(CommandLine, WhatIsReadIsNotOverwritten) {
  const test::TemporaryFolder folder;
  const std::string scene = folder.write("a.gltf", test::read_file(cornell_box));
  expect_refused(run_vernier({"render", scene, "-o", folder.file("a.png"), "--stats", scene}), 2,
                 "a.gltf: is read and would be overwritten");
  const std::string picture = folder.write("b.png", "");
  expect_refused(run_vernier({"compare", picture, picture, "--heatmap", folder.file("./b.png")}), 2,
                 "b.png: is read and would be overwritten");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.gltf", "b.png"}));
}

TEST(CommandLine, NamesWhatIsMissing) {
  expect_refused(run_vernier({}), 2, "missing COMMAND");
  expect_refused(run_vernier({"rendr"}), 2, "unknown command 'rendr'; did you mean 'render'?");
  expect_refused(run_vernier({"render"}), 2, "missing SCENE (.gltf, .glb)");
  expect_refused(run_vernier({"render", cornell_box}), 2, "missing -o FILE (.exr, .png, .jpg)");
  expect_refused(run_vernier({"info"}), 2, "missing SCENE (.gltf, .glb)");
  expect_refused(run_vernier({"info", cornell_box, "--jsn"}), 2, "did you mean '--json'?");
}

TEST(CommandLine, HelpNamesEveryFlagOfRender) {
  const ProcessResult help = run_vernier({"render", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.err, "");
  for (const char* flag :
       {"--integrator", "--show",        "--spp",        "--time",      "--size",          "--crop",
        "--camera",     "--env",         "--env-rotate", "--env-scale", "--exposure",      "--view",
        "--ocio",       "--max-depth",   "--seed",       "--threads",   "--accelerator",   "--stats",
        "--progress",   "--quiet",       "--verbose",    "--strict",    "--output",        "--variant",
        "--at",         "--frames",      "--fps",        "--turntable", "--skip-existing", "--keep-going",
        "--draft",      "--write-every", "--format"})
    EXPECT_THAT(help.out, HasSubstr(flag));
}

TEST(CommandLine, HelpAndVersion) {
  const ProcessResult help = run_vernier({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* text : {"render", "info", "compare", "Exit codes: 0 done"})
    EXPECT_THAT(help.out, HasSubstr(text));
  const ProcessResult info = run_vernier({"info", "--help"});
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_THAT(info.out, HasSubstr("--json"));
  const ProcessResult version = run_vernier({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, StartsWith("vernier "));
}

TEST(CommandLine, ListsOnRequestWithoutAScene) {
  EXPECT_THAT(run_vernier({"render", "--integrator", "help"}).out,
              testing::AllOf(HasSubstr("raycast"), HasSubstr("whitted"), HasSubstr("path")));
  EXPECT_THAT(run_vernier({"render", "--accelerator", "help"}).out,
              testing::AllOf(HasSubstr("embree"), HasSubstr("bvh"), testing::Not(HasSubstr("brute_force"))));
  EXPECT_THAT(run_vernier({"render", "--accelerator", "help-all"}).out, HasSubstr("brute_force"));
  EXPECT_THAT(run_vernier({"render", "--view", "help"}).out, HasSubstr("ACES SDR"));
  EXPECT_THAT(run_vernier({"render", "--show", "help"}).out, HasSubstr("barycentric"));
}

}  // namespace
}  // namespace vernier
