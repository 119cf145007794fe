// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/vernier/job_list.h"
#include "tests/apps/animated_scene.h"
#include "tests/support/documented_fields.h"
#include "tests/support/process.h"
#include "vernier/error.h"

// Lists of jobs: each line of a list is a run of its own.

namespace vernier::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(JobList, WordsAreAsAShellTakesThem) {
  EXPECT_THAT(apps::split_words("a.glb  -o\tb.png\r"), ElementsAre("a.glb", "-o", "b.png"));
  EXPECT_THAT(apps::split_words(R"('a b.glb' "c d" e\ f)"), ElementsAre("a b.glb", "c d", "e f"));
  EXPECT_THAT(apps::split_words(R"(x'y z'"w" '' "" '\n')"), ElementsAre("xy zw", "", "", "\\n"));
  EXPECT_THAT(apps::split_words(R"("\"\\\$\`\n")"), ElementsAre("\"\\$`\\n"));
  EXPECT_THAT(apps::split_words("a#b # c"), ElementsAre("a#b"));
  EXPECT_THAT(apps::split_words("'#' \\#"), ElementsAre("#", "#"));
  EXPECT_THAT(apps::split_words("*.glb $HOME ~"), ElementsAre("*.glb", "$HOME", "~"));
  EXPECT_THAT(apps::split_words("  # nothing"), IsEmpty());
}

TEST(JobList, LinesAreJoinedCountedAndFreedOfTheCommand) {
  std::istringstream text("# first\n\na.glb \\\n  -o \\\n a.png\nvernier render b.glb\n");
  const auto jobs = apps::read_job_list(text, "list");
  ASSERT_EQ(jobs.size(), 2u);
  EXPECT_EQ(jobs[0].number, 3);
  EXPECT_THAT(jobs[0].words, ElementsAre("a.glb", "-o", "a.png"));
  EXPECT_EQ(jobs[1].number, 6);
  EXPECT_THAT(jobs[1].words, ElementsAre("b.glb"));
}

TEST(JobList, AQuoteThatDoesNotEndIsToldWithItsLine) {
  std::istringstream text("a.glb\nb 'c\n");
  try {
    apps::read_job_list(text, "list");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("list: line 2: a ' is opened and not closed"));
  }
}

class Jobs : public testing::Test {
 protected:
  ProcessResult render(const std::string& lines, std::vector<std::string> more = {}) const {
    more.insert(more.begin(),
                {"render", "--jobs", folder_.write("jobs.txt", lines), "--size", "16x12", "--spp", "2"});
    return run_vernier(more);
  }
  std::string bytes(const std::string& name) const { return read_file(folder_.file(name)); }
  /// The line of a job that renders a scene to a file of the folder.
  std::string line(const std::string& scene, const std::string& name) const {
    return fmt::format("'{}' -o '{}'\n", scene, folder_.file(name));
  }
  bool is_there(const std::string& name) const { return std::filesystem::exists(folder_.file(name)); }

  const TemporaryFolder folder_;
  const std::string scene_ = animated_scene().save(folder_);
};

TEST_F(Jobs, MakeThePicturesThatTheirLinesMakeAlone) {
  const ProcessResult result =
      render(line(cornell_box, "a b.exr") + "# a comment\n" + line(two_spheres, "b.exr") +
                 fmt::format("{} --frames 1-2 --fps 4 -o {} --spp 1\n", scene_, folder_.file("f.##.exr")),
             {"--progress", "none"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto alone = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", "--size", "16x12", "-q", "-o", folder_.file("alone.exr")});
    EXPECT_EQ(run_vernier(arguments).exit_code, 0);
    return bytes("alone.exr");
  };
  EXPECT_EQ(bytes("a b.exr"), alone({cornell_box, "--spp", "2"}));
  EXPECT_EQ(bytes("b.exr"), alone({two_spheres, "--spp", "2"}));
  EXPECT_EQ(bytes("f.01.exr"), alone({scene_, "--at", "0.25", "--spp", "1"}));
  EXPECT_EQ(bytes("f.02.exr"), alone({scene_, "--at", "0.5", "--spp", "1"}));
}

TEST_F(Jobs, ComeFromStandardInput) {
  const std::string list = folder_.write("jobs.txt", line(cornell_box, "a.png"));
  const ProcessResult result = run_process(
      {"/bin/sh", "-c", std::string(VERNIER_BINARY) + " render --jobs - --size 8x8 --spp 1 -q < " + list});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(is_there("a.png"));
}

TEST_F(Jobs, ScenesBesideTheListAreEveryJobs) {
  const ProcessResult result =
      render("-o " + folder_.file("front.png") + "\n--azimuth 90 -o " + folder_.file("side.png") + "\n",
             {cornell_box, "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(bytes("front.png"), bytes("side.png"));
}

TEST_F(Jobs, NothingIsRenderedWhenOneIsWrong) {
  for (const auto& [wrong, text] :
       {std::pair(line(cornell_box, "b.png") + cornell_box + " --spq 3\n",
                  "jobs.txt: line 3: unknown flag '--spq'; did you mean '--spp'?"),
        std::pair(line("none.glb", "b.png"), "jobs.txt: line 2: none.glb: cannot be read: No such file"),
        std::pair(line(cornell_box, "none/b.png"), "jobs.txt: line 2: "),
        std::pair(line(cornell_box, "a.png"), "a.png: is written by the job of line 1; name another output"),
        std::pair(cornell_box + " --env " + folder_.file("a.png") + " -o " + folder_.file("b.png") + "\n",
                  "a.png"),
        std::pair(cornell_box + " --progress json\n", "--progress is for all jobs; give it beside the list"),
        std::pair(std::string("--help\n"), "jobs.txt: line 2: ")}) {
    const ProcessResult result = render(line(cornell_box, "a.png") + wrong);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_FALSE(is_there("a.png")) << text;
  }
  EXPECT_THAT(render("# nothing\n").err, HasSubstr("jobs.txt: has no jobs"));
}

TEST_F(Jobs, TheOthersAreRenderedWhenTheRunKeepsGoing) {
  const std::string broken = folder_.write("broken.gltf", "{");
  const ProcessResult result =
      render(cornell_box + " --spq\n" + line(broken, "b.png") + line(cornell_box, "c.png"), {"--keep-going"});
  EXPECT_EQ(result.exit_code, 2);  // the first failure's
  EXPECT_THAT(result.err, HasSubstr("error: " + folder_.file("jobs.txt") + ": line 1: unknown flag"));
  EXPECT_THAT(result.err, HasSubstr("jobs.txt: line 2: " + broken));
  EXPECT_THAT(result.err, HasSubstr("error: 2 of 3 jobs failed"));
  EXPECT_TRUE(is_there("c.png"));
}

TEST_F(Jobs, AreEventsForPrograms) {
  const std::string broken = folder_.write("broken.gltf", "{");
  const ProcessResult result =
      render(line(broken, "a.png") + line(cornell_box, "b.png"), {"--keep-going", "--progress", "json"});
  EXPECT_EQ(result.exit_code, 3);
  std::vector<std::string> told;
  for (const std::string& text : result.err_lines()) {
    const auto event = nlohmann::json::parse(text);
    EXPECT_THAT(undocumented_fields(event, "progress.md"), IsEmpty()) << event;
    if (event["event"] == "progress") continue;
    told.push_back(event["event"].get<std::string>() +
                   (event.contains("job") ? std::to_string(event["job"].get<int>()) : ""));
    if (event.contains("picture")) {
      EXPECT_EQ(event["picture"], 2);
      EXPECT_EQ(event["pictures"], 2);
    }
  }
  EXPECT_THAT(told, ElementsAre("started", "job1", "failed1", "job_finished1", "job2", "rendering2", "wrote2",
                                "job_finished2", "failed", "finished"));
}

TEST_F(Jobs, WhatIsWrongWithARunIsToldBeforeItsEnvironmentIsDecoded) {
  const std::string environment = folder_.write("broken.hdr", "no picture");
  const auto failure = [&](const std::string& output) {
    return run_vernier({"render", cornell_box, "--env", environment, "-o", output}).err;
  };
  EXPECT_THAT(failure(folder_.file("none/a.png")), HasSubstr("none/a.png"));
  EXPECT_THAT(failure(folder_.file("a.####.png")), HasSubstr("--frames or --turntable gives some"));
  EXPECT_THAT(failure(folder_.file("a.png")), HasSubstr("broken.hdr"));
}

}  // namespace
}  // namespace vernier::test
