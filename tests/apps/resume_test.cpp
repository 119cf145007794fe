// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <nlohmann/json.hpp>

#include "core/base/file_lock.h"
#include "core/image/image_io.h"
#include "integrators/render/checkpoint.h"
#include "tests/support/process.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class ResumeCommand : public testing::Test {
 protected:
  ProcessResult render(const std::string& name, const std::vector<std::string>& more,
                       const SendSignal& signal = {}) {
    std::vector<std::string> arguments{"render", cornell_box, "--size", "64x64", "-o", folder_.file(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_vernier(arguments, signal);
  }
  std::vector<float> values(const std::string& name) { return read_layers(folder_.file(name)).image.values; }
  json stats(const std::string& name) { return json::parse(read_file(folder_.file(name))); }

  const TemporaryFolder folder_;
  const std::string ckpt_ = folder_.file("a.ckpt");
};

TEST_F(ResumeCommand, SignalThenTheRest) {
  // With an error figure a slow machine has come as far as some passes, too.
  const ProcessResult cut = render("cut.exr", {"--spp", "5000", "--checkpoint", ckpt_, "--progress", "json"},
                                   {SIGTERM, "\"rel_rmse\":0."});
  ASSERT_EQ(cut.exit_code, 5) << cut.err;
  const double done = std::stod(read_layers(folder_.file("cut.exr")).metadata.at("vernier:samplesPerPixel"));
  ASSERT_GT(done, 1);
  // As much again, in one go and in two.
  const std::string spp = std::to_string(int(2 * done) + 3);
  const std::vector<std::string> layers{"--spp", spp, "--aov", "error,samples,half,albedo", "-q"};
  std::vector<std::string> resumed = layers;
  resumed.insert(resumed.end(), {"--resume", ckpt_, "--stats", folder_.file("a.json"), "--threads", "1"});
  const ProcessResult rest = render("rest.exr", resumed);
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  ASSERT_EQ(render("whole.exr", layers).exit_code, 0);
  EXPECT_EQ(values("rest.exr"), values("whole.exr"));

  const json a = stats("a.json");
  EXPECT_NEAR(a["picture"]["samples_per_pixel"], 2 * done + 3, 1);
  EXPECT_EQ(a["resumed"]["samples_per_pixel"], done);
  EXPECT_EQ(a["resumed"]["file"], ckpt_);
  EXPECT_GT(a["seconds"]["render"], a["resumed"]["seconds"]);
  EXPECT_EQ(a["picture"]["samples"], a["rays"]["camera"]);
}

TEST_F(ResumeCommand, AnotherBuildIsToldOf) {
  ASSERT_EQ(render("a.exr", {"--spp", "4", "--checkpoint", ckpt_, "-q"}).exit_code, 0);
  const ProcessResult same = render("a.exr", {"--spp", "5", "--resume", ckpt_, "--progress", "none"});
  ASSERT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.err, testing::Not(HasSubstr("build")));
  Checkpoint checkpoint = read_checkpoint(ckpt_);
  EXPECT_THAT(take(checkpoint.identity, "build"), testing::MatchesRegex("[0-9a-f]{40}"));
  checkpoint.identity.emplace_back("build", "another");
  write_checkpoint(ckpt_, checkpoint.identity, *checkpoint.state);
  const ProcessResult other = render("a.exr", {"--spp", "5", "--resume", ckpt_, "--progress", "none"});
  EXPECT_EQ(other.exit_code, 0) << other.err;
  EXPECT_THAT(other.err, HasSubstr("warning: " + ckpt_ + " was written by another build"));
}

TEST_F(ResumeCommand, AnotherPlatformIsToldOf) {
  ASSERT_EQ(render("a.exr", {"--spp", "4", "--checkpoint", ckpt_, "-q"}).exit_code, 0);
  Checkpoint checkpoint = read_checkpoint(ckpt_);
  const std::string here = take(checkpoint.identity, "platform");
  EXPECT_THAT(here, HasSubstr(", glibc "));
  checkpoint.identity.emplace_back("platform", "another");
  write_checkpoint(ckpt_, checkpoint.identity, *checkpoint.state);
  const ProcessResult other = render("a.exr", {"--spp", "5", "--resume", ckpt_, "--progress", "none"});
  EXPECT_EQ(other.exit_code, 0) << other.err;
  EXPECT_EQ(other.err_lines().size(), 2u) << other.err;
  EXPECT_THAT(other.err, HasSubstr("written on another platform (another; this is " + here + ")"));
}

// What a checkpoint says of itself in its header is checked against what it holds.
TEST_F(ResumeCommand, ACheckpointOfAnotherSizeThanItSays) {
  ASSERT_EQ(render("a.exr", {"--spp", "2", "--checkpoint", ckpt_, "-q"}).exit_code, 0);
  Checkpoint checkpoint = read_checkpoint(ckpt_);
  for (const bool adaptive : {true, false}) {
    write_checkpoint(ckpt_, checkpoint.identity,
                     RenderState(adaptive ? 16 : 64, adaptive ? 16 : 64, adaptive));
    const ProcessResult result = render("b.exr", {"--spp", "4", "--resume", ckpt_, "-q"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, HasSubstr("is damaged: what it holds is not of the size that it says"));
  }
  const std::string other = folder_.file("b.ckpt");
  ASSERT_EQ(render("a.exr", {"--spp", "2", "--seed", "1", "--checkpoint", other, "-q"}).exit_code, 0);
  for (const auto& inputs : {std::array{ckpt_, other}, std::array{other, ckpt_}}) {
    write_checkpoint(ckpt_, checkpoint.identity, RenderState(16, 16, true));
    const ProcessResult merged = run_vernier({"merge", inputs[0], inputs[1], "-o", folder_.file("c.exr")});
    EXPECT_EQ(merged.exit_code, 3);
    EXPECT_THAT(merged.err, HasSubstr("is damaged: its picture is not of the size that it says"));
  }
}

TEST_F(ResumeCommand, OneCommandStartsAndGoesOn) {
  const std::vector<std::string> again{"--checkpoint", ckpt_, "--resume", ckpt_, "--progress", "none"};
  std::vector<std::string> more = again;
  more.insert(more.end(), {"--spp", "20", "--stats", folder_.file("a.json")});
  const ProcessResult first = render("a.exr", more);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr("not there yet"));
  EXPECT_EQ(stats("a.json")["checkpoint"]["written"], 1);
  EXPECT_EQ(stats("a.json")["checkpoint"]["bytes"], read_file(ckpt_).size());
  EXPECT_FALSE(stats("a.json").contains("resumed"));
  const ProcessResult second = render("b.exr", more);
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_THAT(second.err, HasSubstr("going on from " + ckpt_ + ": 20"));
  EXPECT_EQ(values("a.exr"), values("b.exr")) << "all was there";
  EXPECT_EQ(stats("a.json")["picture"]["samples"], stats("a.json")["resumed"]["samples"]);
}

TEST_F(ResumeCommand, ACheckpointNeedsNoPicture) {
  const ProcessResult result = run_vernier(
      {"render", cornell_box, "--size", "64x64", "--spp", "2", "--checkpoint", ckpt_, "--progress", "none"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, testing::StartsWith("wrote " + ckpt_ + ": 64x64, 2 spp"));
  ASSERT_EQ(render("a.exr", {"--spp", "2", "--resume", ckpt_, "-q"}).exit_code, 0);
  ASSERT_EQ(render("b.exr", {"--spp", "2", "-q"}).exit_code, 0);
  EXPECT_EQ(values("a.exr"), values("b.exr"));
}

TEST_F(ResumeCommand, ACheckpointIsDroppedWhenThePictureIsThere) {
  const std::vector<std::string> dropped{"--checkpoint", ckpt_, "--drop-checkpoint"};
  std::vector<std::string> cut{"--spp", "100000", "--progress", "json"};
  cut.insert(cut.end(), dropped.begin(), dropped.end());
  ASSERT_EQ(render("a.exr", cut, {SIGTERM, "\"samples\":"}).exit_code, 5);
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a.ckpt", "a.exr"}));
  std::vector<std::string> rest{"--spp", "2", "-q", "--resume", ckpt_};
  rest.insert(rest.end(), dropped.begin(), dropped.end());
  ASSERT_EQ(render("a.exr", rest).exit_code, 0);
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a.exr"}));
  EXPECT_EQ(render("a.exr", {"--drop-checkpoint"}).exit_code, 2);
}

TEST_F(ResumeCommand, TwoWritersAreRefused) {
  const FileLock first(ckpt_);
  const ProcessResult second = render("a.exr", {"--spp", "2", "--checkpoint", ckpt_, "-q"});
  EXPECT_EQ(second.exit_code, 3);
  EXPECT_THAT(second.err, testing::StartsWith("error: " + ckpt_ + ": is being written by process "));
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a.ckpt.lock"}));
}

TEST_F(ResumeCommand, AnotherRenderIsRefused) {
  ASSERT_EQ(render("a.exr", {"--spp", "2", "--checkpoint", ckpt_, "-q"}).exit_code, 0);
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--seed", "7"}, "seed was 0, is 7"},
      {{"--adaptive", "off"}, "adaptive was on, is off"},
      {{"--integrator", "whitted"}, "integrator was path, is whitted"},
      {{"--max-depth", "3"}, "max-depth was 16, is 3"},
      {{"--crop", "8x8+1+2"}, "crop was none, is 8x8+1+2"},
      {{"--accelerator", "bvh"}, "accelerator was list, is bvh"}};
  for (const auto& [flags, expected] : cases) {
    std::vector<std::string> more = flags;
    more.insert(more.end(), {"--spp", "4", "--resume", ckpt_, "-q"});
    const ProcessResult result = render("b.exr", more);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.err, "error: " + ckpt_ + ": is of another render: " + expected + "\n");
  }
  const std::string spheres = VERNIER_SOURCE_DIR "/tests/scenes/layer_spheres.gltf";
  const ProcessResult other = run_vernier(
      {"render", spheres, "--size", "32x32", "-o", folder_.file("b.exr"), "--resume", ckpt_, "-q"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("scene was "));
  EXPECT_THAT(other.err, HasSubstr("size was 64x64, is 32x32"));
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a.ckpt", "a.exr"}));
}

TEST_F(ResumeCommand, FilesThatCannotBeUsed) {
  folder_.write("b.ckpt", "not one");
  const ProcessResult wrong = render("a.exr", {"--resume", folder_.file("b.ckpt"), "-q"});
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_EQ(wrong.err, "error: " + folder_.file("b.ckpt") + ": is not a checkpoint of 'vernier render'\n");
  EXPECT_EQ(render("a.exr", {"--resume", folder_.file("none.ckpt"), "-q"}).exit_code, 3);
  const ProcessResult nowhere = render("a.exr", {"--checkpoint", folder_.file("no/a.ckpt"), "-q"});
  EXPECT_EQ(nowhere.exit_code, 3);
  EXPECT_THAT(nowhere.err, HasSubstr("no/a.ckpt: cannot be written: folder"));
  EXPECT_EQ(render("a.exr", {"--checkpoint", ckpt_, "--checkpoint-every", "often"}).exit_code, 2);
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"b.ckpt"}));
}

}  // namespace
}  // namespace vernier::test
