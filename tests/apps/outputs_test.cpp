// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "core/image/image_io.h"
#include "tests/support/process.h"

namespace vernier::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class OutputFiles : public testing::Test {
 protected:
  ProcessResult render(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", cornell_box, "--size",     "16x16",
                                       "--spp",  "2",         "--progress", "none"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_vernier(arguments);
  }
  static bool is_picture(const std::string& file) { return file.ends_with(".exr") || file.ends_with(".png"); }
  /// A name in the folder for a device that takes nothing, as a full disk does.
  std::string full(const std::string& name) {
    fs::create_symlink("/dev/full", folder_.file(name));
    return folder_.file(name);
  }

  const TemporaryFolder folder_;
};

TEST_F(OutputFiles, OneThatFailsDoesNotKeepTheOthersFromBeingWritten) {
  const std::vector<std::string> flags{"-o", "-o", "--stats", "--report", "--checkpoint"};
  const std::vector<std::string> names{"a.exr", "b.png", "c.json", "d.html", "e.ckpt"};
  for (size_t failing = 0; failing < names.size(); ++failing) {
    SCOPED_TRACE(names[failing]);
    std::vector<std::string> arguments, written;
    for (size_t i = 0; i < names.size(); ++i) {
      const std::string file = i == failing ? full("full" + names[i].substr(1)) : folder_.file(names[i]);
      arguments.insert(arguments.end(), {flags[i], file});
      if (i != failing) written.push_back(file);
    }
    const ProcessResult result = render(arguments);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, HasSubstr("error: " + arguments[2 * failing + 1] +
                                      ": cannot be written: No space left on device\n"));
    for (const std::string& file : written) {
      EXPECT_GT(read_file(file).size(), 100u) << file;
      EXPECT_EQ(result.out.find(file) != std::string::npos, is_picture(file)) << result.out;
      fs::remove(file);
    }
    fs::remove(arguments[2 * failing + 1]);
  }
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(OutputFiles, ExrFilesAreStoredAsAsked) {
  const std::string exr = folder_.file("a.exr"), half = folder_.file("half.exr");
  const auto stored = [](const std::string& file) { return std::filesystem::file_size(file); };
  ASSERT_EQ(render({"-o", exr, "--compression", "none"}).exit_code, 0);
  ASSERT_EQ(render({"-o", half, "--compression", "none", "--half"}).exit_code, 0);
  constexpr size_t pixels = size_t{16} * 16;
  EXPECT_NEAR(double(stored(exr) - stored(half)), pixels * 3 * 2, 64);  // but for the longer command
  EXPECT_EQ(run_vernier({"develop", exr, "-o", half, "--half", "--compression", "dwaa:45", "-q"}).exit_code,
            0);

  const auto refused = [&](const std::vector<std::string>& flags, const std::string& text) {
    const ProcessResult result = render(flags);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(text));
  };
  refused({"-o", folder_.file("b.png"), "--half"}, "--half: is about .exr files");
  refused({"-o", exr, "--compression", "zpi"}, "did you mean 'zip");
  refused({"-o", exr, "--compression", "zip:4"}, "no level");
  refused({"-o", exr, "--compression", "dwaa:x"}, "dwaa:45");
  refused({"-o", exr, "--compression", "dwab", "--aov", "depth"}, "--compression: loses digits");
}

TEST_F(OutputFiles, WhatCannotBeWrittenIsFoundBeforeRendering) {
  const std::string good = folder_.file("a.png");
  const std::vector<std::vector<std::string>> cases{{"-o", good, "-o", "/proc/a.png"},
                                                    {"-o", good, "--stats", "/proc/a.json"},
                                                    {"-o", good, "--report", "/proc/a.html"},
                                                    {"-o", good, "--checkpoint", "/proc/a.ckpt"}};
  for (std::vector<std::string> arguments : cases) {
    // An hour is longer than the test may take.
    arguments.insert(arguments.begin(), {"render", cornell_box, "--time", "1h"});
    const ProcessResult result = run_vernier(arguments);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr("error: /proc/a."));
    EXPECT_THAT(result.err, HasSubstr(": cannot be written: "));
  }
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(OutputFiles, SignalsLeaveNothingHalfWritten) {
  for (const int signal : {SIGINT, SIGTERM}) {
    // Two at once: to stop, and to end at once, wherever the program is by then.
    const ProcessResult result = run_vernier(
        {"render", cornell_box, "--size", "64x64", "--time", "1h", "-o", folder_.file("a.exr"), "--progress",
         "json", "--checkpoint", folder_.file("a.ckpt"), "--checkpoint-every", "0.001"},
        {signal, "\"event\":\"progress\"", 2});
    EXPECT_NE(result.exit_code, 0);
    for (const std::string& name : folder_.names()) EXPECT_THAT(name, testing::StartsWith("a."));
  }
}

}  // namespace
}  // namespace vernier::test
