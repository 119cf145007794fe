// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "core/image/image_io.h"
#include "tests/support/process.h"

namespace vernier {
namespace {

class StoppedBy : public testing::TestWithParam<int> {};

TEST_P(StoppedBy, SignalWritesThePictureSoFar) {
  const test::TemporaryFolder folder;
  const test::ProcessResult result =
      test::run_vernier({"render", test::cornell_box, "-o", folder.file("a.exr"), "--size", "64x64", "--time",
                         "1h", "--progress", "json", "--stats", folder.file("a.json")},
                        {GetParam(), "\"event\":\"progress\""});
  EXPECT_EQ(result.exit_code, 5) << result.err;
  const LayeredImage file = read_layers(folder.file("a.exr"));
  EXPECT_EQ(file.image.width, 64);
  EXPECT_EQ(file.metadata.at("vernier:stoppedBy"), "interrupted");
  EXPECT_GT(std::stod(file.metadata.at("vernier:samples")), 0);
  const auto stats = nlohmann::json::parse(test::read_file(folder.file("a.json")));
  EXPECT_EQ(stats["picture"]["stopped_by"], "interrupted");
}

INSTANTIATE_TEST_SUITE_P(Stop, StoppedBy, testing::Values(SIGINT, SIGTERM));

}  // namespace
}  // namespace vernier
