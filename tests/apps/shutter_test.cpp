// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image_io.h"
#include "tests/apps/animated_scene.h"
#include "tests/support/process.h"

// Motion blur from the command line.

namespace vernier::test {
namespace {

using testing::HasSubstr;

class ShutterFlag : public testing::Test {
 protected:
  ProcessResult render(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(),
                     {"render", scene_, "--size", "24x16", "--spp", "16", "--env", "none", "--look-from",
                      "0,0,5", "--look-at", "0,0,0", "--ortho", "4", "--progress", "none"});
    return run_vernier(arguments);
  }
  Image picture(std::vector<std::string> arguments, const std::string& name = "a.exr") const {
    arguments.insert(arguments.end(), {"-o", folder_.file(name)});
    const ProcessResult result = render(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return *read_layers(folder_.file(name)).single("R");
  }
  std::string refusal(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"-o", folder_.file("none.exr")});
    const ProcessResult result = render(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    return result.err;
  }
  std::string bytes(const std::string& name) const { return read_file(folder_.file(name)); }

  const TemporaryFolder folder_;
  const std::string scene_ = animated_scene().save(folder_);
};

/// Columns of a row that show something, of which the triangle moves a metre, six pixels, a second.
int lit_columns(const Image& picture, int row) {
  int lit = 0;
  for (int x = 0; x < picture.width; ++x) lit += *picture.pixel(x, row) > 0;
  return lit;
}

TEST_F(ShutterFlag, WidensWhatMovesByItsWay) {
  constexpr int row = 7;
  const int still = lit_columns(picture({"--at", "0.5"}), row);
  EXPECT_NEAR(lit_columns(picture({"--at", "0.5", "--shutter", "-0.5,0.5"}), row), still + 4, 1);
  EXPECT_NEAR(lit_columns(picture({"--at", "0.5", "--shutter", "1", "--fps", "2"}), row), still + 2, 1);
}

TEST_F(ShutterFlag, CountsInFramesAboutTheFramesTime) {
  picture({"--at", "0.5", "--shutter", "0.5", "--fps", "4"}, "part.exr");
  picture({"--at", "0.5", "--shutter", "-0.0625,0.0625"}, "seconds.exr");
  picture({"--frames", "2", "--shutter", "0.5", "--fps", "4"}, "frame.exr");
  const auto values = [&](const char* name) { return read_layers(folder_.file(name)).single("R")->values; };
  EXPECT_EQ(values("part.exr"), values("seconds.exr"));
  EXPECT_EQ(bytes("part.exr"), bytes("frame.exr"));
}

TEST_F(ShutterFlag, GivesTheSameBytesForAnyNumberOfThreads) {
  picture({"--at", "0.5", "--shutter", "-0.5,0.5", "-t", "1", "--aov", "all"}, "one.exr");
  picture({"--at", "0.5", "--shutter", "-0.5,0.5", "-t", "2", "--aov", "all"}, "two.exr");
  EXPECT_EQ(bytes("one.exr"), bytes("two.exr"));
}

TEST_F(ShutterFlag, BlursWhatATurntablePasses) {
  const Image still = picture({"--turntable", "6", "--frames", "2"});
  const Image blurred = picture({"--turntable", "6", "--frames", "2", "--shutter", "1"});
  EXPECT_NE(still.values, blurred.values);
}

TEST_F(ShutterFlag, LeansWhatMovesWhenItRolls) {
  const std::vector<std::string> moving{"--at", "0.5", "--shutter", "-0.5,0.5"};
  std::vector<std::string> rolling = moving;
  rolling.insert(rolling.end(), {"--shutter-shape", "rolling:0"});
  const Image picture_of_rows = picture(rolling);
  EXPECT_NE(picture_of_rows.values, picture(moving).values);
  // The exposure of a row has no length: nothing is wider than where it stands still.
  EXPECT_NEAR(lit_columns(picture_of_rows, 7), lit_columns(picture({"--at", "0.5"}), 7), 1);
}

TEST_F(ShutterFlag, SaysWhatItFollowsAndWhereNothingMoves) {
  const auto said = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", folder_.file("a.exr")});
    return render(arguments).err;
  };
  EXPECT_THAT(said({"--at", "0.5", "--shutter", "0.5"}), HasSubstr("1 of 2 instances move"));
  EXPECT_THAT(said({"--at", "2", "--shutter", "0.5"}), HasSubstr("nothing moves while it is open"));
}

TEST_F(ShutterFlag, RefusesWhatIsNoShutter) {
  EXPECT_THAT(refusal({"--at", "0.5", "--shutter", "2"}), HasSubstr("'2' is no part of a frame"));
  EXPECT_THAT(refusal({"--at", "0.5", "--shutter", "0"}), HasSubstr("'0' is no part of a frame"));
  EXPECT_THAT(refusal({"--at", "0.5", "--shutter", "wide"}), HasSubstr("'wide' is no part of a frame"));
  EXPECT_THAT(refusal({"--at", "0.5", "--shutter", "0.1,x"}), HasSubstr("'0.1,x' are not two numbers"));
  EXPECT_THAT(refusal({"--at", "0.5", "--shutter", "0.1,0.1"}), HasSubstr("closes before it has opened"));
  EXPECT_THAT(refusal({"--shutter", "0.5"}), HasSubstr("add --frames, --at or --turntable"));
  EXPECT_THAT(refusal({"--at", "0.5", "--shutter-shape", "box"}),
              HasSubstr("--shutter-shape needs --shutter"));
  const auto shape = [&](const char* name) {
    return refusal({"--at", "0.5", "--shutter", "0.5", "--shutter-shape", name});
  };
  EXPECT_THAT(shape("roling"), HasSubstr("rolling"));
  EXPECT_THAT(shape("rolling:2"), HasSubstr("expected rolling:0 to rolling:1"));
}

}  // namespace
}  // namespace vernier::test
