// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/image/image_io.h"
#include "tests/support/process.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Whether a program is installed.
bool is_there(const std::string& program) {
  return run_process({"/bin/sh", "-c", "command -v " + program}).exit_code == 0;
}

class FarmCommand : public testing::Test {
 protected:
  /// `vernier farm ARGUMENTS`, of a small picture.
  static ProcessResult farm(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "farm");
    arguments.insert(arguments.end(), {"--size", "32x32", "-q"});
    return run_vernier(arguments);
  }
  /// The script that it prints, in a file.
  std::string script(const std::vector<std::string>& arguments) {
    const ProcessResult result = farm(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return folder_.write("farm.sh", result.out);
  }
  std::vector<std::string> status(const std::string& parts) {
    const ProcessResult result = run_vernier({"farm", "status", folder_.file(parts)});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return lines(result.out);
  }
  static std::vector<std::string> lines(const std::string& text) {
    return ProcessResult{0, {}, text}.err_lines();
  }
  /// Seeds 1 to N rendered one by one and merged.
  std::vector<float> sum_of_seeds(int count, const std::string& spp) {
    std::vector<std::string> merge{"merge", "-q", "-o", folder_.file("sum.exr")};
    for (int seed = 1; seed <= count; ++seed) {
      merge.push_back(folder_.file("seed" + std::to_string(seed)));
      run_vernier({"render", cornell_box, "--size", "32x32", "-q", "--spp", spp, "--seed",
                   std::to_string(seed), "--checkpoint", merge.back()});
    }
    EXPECT_EQ(run_vernier(merge).exit_code, 0);
    return values("sum.exr");
  }
  std::vector<float> values(const std::string& name) { return read_layers(folder_.file(name)).image.values; }

  const TemporaryFolder folder_;
  const std::string out_ = folder_.file("out.exr");
};

TEST_F(FarmCommand, APictureIsTheSumOfItsSeeds) {
  const std::string farm = script({"sh", cornell_box, "--spp", "12", "--parts", "3", "-o", out_});
  const ProcessResult first = run_process({"/bin/bash", farm});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(values("out.exr"), sum_of_seeds(3, "4"));
  const auto told = status("out.parts");
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(told[0], out_ + ": 3 parts by seeds from 1");
  EXPECT_EQ(told[2], "3 parts done, 0 begun, 0 not begun");
  // Again, it goes on from what is there, which is all.
  const std::vector<float> before = values("out.exr");
  ASSERT_EQ(run_process({"/bin/bash", farm}).exit_code, 0);
  EXPECT_EQ(values("out.exr"), before);
}

TEST_F(FarmCommand, APartThatIsLost) {
  const std::string farm =
      script({"sh", cornell_box, "--spp", "12", "--parts", "3", "-o", out_, "--skip-missing"});
  ASSERT_EQ(run_process({"/bin/bash", farm}).exit_code, 0);
  std::filesystem::remove(folder_.file("out.parts/part.2.ckpt"));
  EXPECT_THAT(status("out.parts"), testing::Contains("  not begun: 2"));
  EXPECT_EQ(run_process({"/bin/bash", farm, "merge"}).exit_code, 0);
  EXPECT_EQ(read_layers(out_).metadata.at("vernier:seed"), "1 3");
  EXPECT_EQ(run_process({"/bin/bash", farm, "part", "2"}).exit_code, 0);
  EXPECT_EQ(run_process({"/bin/bash", farm, "merge"}).exit_code, 0);
  EXPECT_EQ(values("out.exr"), sum_of_seeds(3, "4"));
}

TEST_F(FarmCommand, AnErrorAcrossParts) {
  const std::string farm = script({"sh", cornell_box, "--error", "5%", "--parts", "2", "-o", out_});
  const ProcessResult result = run_process({"/bin/bash", farm});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Metadata merged = read_layers(out_).metadata;
  EXPECT_LE(std::stod(merged.at("vernier:relRmse")), 0.05);
  EXPECT_GT(std::stod(merged.at("vernier:samplesPerPixel")), 32) << "the first round was enough";
  EXPECT_GT(std::stoi(read_file(folder_.file("out.parts/goal.2"))), 32);
  EXPECT_THAT(status("out.parts")[1], HasSubstr("; 5% is asked for"));
}

TEST_F(FarmCommand, FramesHaveTheBytesOfOneRun) {
  const std::string pictures = folder_.file("turn.##.png");
  const std::string farm =
      script({"sh", two_spheres, "--turntable", "5", "--spp", "4", "--parts", "2", "-o", pictures});
  EXPECT_THAT(read_file(farm), HasSubstr("frames=(1-3 4-5)"));
  ASSERT_EQ(run_process({"/bin/bash", farm, "part", "2"}).exit_code, 0);
  EXPECT_EQ(status("turn.parts")[1], "2 frames done, 0 begun, 3 not begun");
  const ProcessResult all = run_process({"/bin/bash", farm});
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(status("turn.parts")[1], "5 frames done, 0 begun, 0 not begun");
  EXPECT_EQ(run_vernier({"render", two_spheres, "--turntable", "5", "--spp", "4", "--size", "32x32", "-q",
                         "-o", folder_.file("one.##.png")})
                .exit_code,
            0);
  for (int frame = 1; frame <= 5; ++frame) {
    const std::string name = ".0" + std::to_string(frame) + ".png";
    EXPECT_EQ(read_file(folder_.file("turn" + name)), read_file(folder_.file("one" + name)));
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.file("turn.parts")), {}), 1)
      << "only the plan is left";
}

TEST_F(FarmCommand, NamesThatAShellWouldTakeApart) {
  const std::string odd = folder_.write("it's $HOME; a \"scene\".gltf", read_file(cornell_box));
  const std::string farm =
      script({"sh", odd, "--spp", "4", "--parts", "2", "-o", folder_.file("the 'out' (1).exr")});
  const ProcessResult result = run_process({"/bin/bash", farm});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder_.file("the 'out' (1).exr")));
}

TEST_F(FarmCommand, ScriptsAreGoodShell) {
  if (!is_there("shellcheck")) GTEST_SKIP() << "shellcheck is not installed";
  for (const char* scheduler : {"sh", "slurm"})
    for (const auto& kind : {std::vector<std::string>{"--parts", "4"}, {"--turntable", "4"}}) {
      std::vector<std::string> arguments{scheduler, cornell_box, "-o", folder_.file("a.##.exr")};
      if (kind[0] == "--parts") arguments.back() = out_;
      arguments.insert(arguments.end(), kind.begin(), kind.end());
      const ProcessResult checked = run_process({"/usr/bin/env", "shellcheck", script(arguments)});
      EXPECT_EQ(checked.exit_code, 0) << checked.out;
    }
}

TEST_F(FarmCommand, SlurmGetsAnArrayAndItsMerge) {
  // In place of sbatch: numbers its jobs and writes down what it was given.
  const std::string log = folder_.file("log");
  const std::string sbatch =
      folder_.write("bin/sbatch", "#!/bin/bash\necho \"$@\" >> '" + log + "'\nwc -l < '" + log + "'\n");
  std::filesystem::permissions(sbatch, std::filesystem::perms::owner_all);
  const std::string path = "PATH=" + folder_.file("bin") + ":" + std::getenv("PATH");
  const ProcessResult result =
      run_process({"/usr/bin/env", path, VERNIER_BINARY, "farm", "slurm", cornell_box, "--error", "1%",
                   "--parts", "64", "--threads", "8", "--sbatch=--partition=night", "-o", out_, "--submit"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("submitted 64 parts as job 1\nsubmitted their merge as job 2\n"));
  const auto jobs = lines(read_file(log));
  ASSERT_EQ(jobs.size(), 4u);
  for (const std::string& job : jobs) {
    EXPECT_THAT(job, HasSubstr("--requeue"));
    EXPECT_THAT(job, HasSubstr("--kill-on-invalid-dep=yes"));
    EXPECT_THAT(job, HasSubstr("--cpus-per-task=8 --partition=night " + folder_.file("out.parts/farm.sh")));
  }
  EXPECT_THAT(jobs[0], testing::AllOf(HasSubstr("--array=1-64 "), testing::EndsWith(" part 1")));
  EXPECT_THAT(jobs[1], testing::AllOf(HasSubstr("--dependency=afterok:1 "), testing::EndsWith(" merge 1")));
  EXPECT_THAT(jobs[2], testing::AllOf(HasSubstr("--dependency=afterok:2 "), testing::EndsWith(" part 2")));
  EXPECT_THAT(jobs[3], testing::AllOf(HasSubstr("--dependency=afterok:3 "), testing::EndsWith(" merge 2")));
}

TEST_F(FarmCommand, OpenJobDescription) {
  const ProcessResult result = farm({"openjd", cornell_box, "--spp", "8", "--parts", "2", "-o", out_});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json job = json::parse(result.out);
  EXPECT_EQ(job["specificationVersion"], "jobtemplate-2023-09");
  EXPECT_EQ(job["parameterDefinitions"][0]["default"], ".") << "runners refuse absolute ones";
  ASSERT_EQ(job["steps"].size(), 2u);
  EXPECT_EQ(job["steps"][0]["parameterSpace"]["taskParameterDefinitions"][0]["range"], "1-2");
  EXPECT_EQ(job["steps"][1]["dependencies"][0]["dependsOn"], job["steps"][0]["name"]);
  // Its tasks as a worker would run them.
  for (const auto& step : job["steps"]) {
    const std::string script = folder_.write("task.sh", step["script"]["embeddedFiles"][0]["data"]);
    const bool is_merge = step["name"] == "Merge";
    for (const char* part : {"1", "2"}) {
      std::vector<std::string> words{"/bin/bash"};
      for (std::string word : step["script"]["actions"]["onRun"]["args"]) {
        if (word == "{{Task.File.Script}}") word = script;
        if (word == "{{Param.Folder}}") word = folder_.path().string();
        if (word == "{{Task.Param.Part}}") word = part;
        words.push_back(word);
      }
      const ProcessResult task = run_process(words);
      ASSERT_EQ(task.exit_code, 0) << task.err;
      if (is_merge) break;
    }
  }
  EXPECT_EQ(values("out.exr"), sum_of_seeds(2, "4"));
}

struct Refusal {
  std::vector<std::string> arguments;
  int exit_code;
  std::string text;
};

class FarmRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(FarmRefusal, IsOneClearLine) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments{"farm"};
  for (const std::string& argument : GetParam().arguments)
    arguments.push_back(argument == "SCENE"         ? cornell_box
                        : argument.starts_with("/") ? folder.path().string() + argument
                                                    : argument);
  const ProcessResult result = run_vernier(arguments);
  EXPECT_EQ(result.exit_code, GetParam().exit_code) << result.out;
  EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
  EXPECT_THAT(result.err, HasSubstr(GetParam().text));
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(folder.names(), testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Farm, FarmRefusal,
    testing::Values(
        Refusal{{}, 2, "missing COMMAND; see vernier farm --help"},
        Refusal{{"slurn", "SCENE"}, 2, "did you mean 'slurm'?"},
        Refusal{{"sh", "-o", "/a.exr", "--parts", "2"}, 2, "missing SCENE"},
        Refusal{{"sh", "SCENE", "--parts", "2"}, 2, "missing -o FILE"},
        Refusal{{"sh", "SCENE", "-o", "/a.exr"}, 2, "missing --parts N"},
        Refusal{{"sh", "SCENE", "-o", "/a.exr", "--parts", "1"}, 2, "is no farm"},
        Refusal{{"sh", "SCENE", "-o", "/a.exr", "--parts", "40"}, 2, "less than 2 samples a pixel each"},
        Refusal{{"sh", "SCENE", "-o", "/a.exr", "--parts", "2", "--integrater=path"}, 2, "'--integrator'?"},
        Refusal{
            {"sh", "SCENE", "-o", "/a.exr", "--parts", "2", "--aov", "albedo"}, 2, "looked up in the scene"},
        Refusal{{"sh", "SCENE", "-o", "/a.exr", "--parts", "2", "--denoise", "nlm"}, 2, "denoised by itself"},
        Refusal{
            {"sh", "SCENE", "-o", "/a.exr", "--parts", "2", "--rounds", "3"}, 2, "--rounds needs --error"},
        Refusal{{"sh", "SCENE", "-o", "/{camera}.exr", "--camera", "all", "--parts", "2"}, 2, "all cameras"},
        Refusal{{"sh", "SCENE", "-o", "-", "--parts", "2"}, 2, "standard output"},
        Refusal{{"sh", "/none.glb", "-o", "/a.exr", "--parts", "2"}, 3, "none.glb: cannot be read"},
        Refusal{{"sh", "SCENE", "-o", "/no/a.exr", "--parts", "2"}, 3, "no/a.exr"},
        Refusal{{"sh", "SCENE", "-o", "/a.##.exr", "--turntable", "4", "--parts", "5"}, 2, "only 4 frames"},
        Refusal{{"sh", "SCENE", "-o", "/a.exr", "--parts", "2", "--submit"}, 2, "unknown flag '--submit'"},
        Refusal{{"openjd", "SCENE", "-o", "/a.exr", "--parts", "2", "--skip-missing"}, 2, "--skip-missing"},
        Refusal{{"status"}, 2, "missing FOLDER"},
        Refusal{{"status", "/none"}, 3, "farm.json: cannot be read"}));

}  // namespace
}  // namespace vernier::test
