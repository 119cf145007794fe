// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/image/image_io.h"
#include "tests/support/process.h"

// --texture-filter on the command line: what is approximated says so.

namespace vernier::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class TextureFilterFlag : public testing::Test {
 protected:
  ProcessResult render(const std::vector<std::string>& more) {
    std::vector<std::string> all{
        "render", two_spheres, "-o",      folder_.file("a.exr"),      "--size",     "32x24",
        "--spp",  "2",         "--stats", folder_.file("stats.json"), "--progress", "none"};
    all.insert(all.end(), more.begin(), more.end());
    return run_vernier(all);
  }
  Metadata header() const { return read_layers(folder_.file("a.exr")).metadata; }
  nlohmann::json picture() const {
    return nlohmann::json::parse(read_file(folder_.file("stats.json")))["picture"];
  }

  const TemporaryFolder folder_;
};

TEST_F(TextureFilterFlag, NobodyGetsItWithoutAsking) {
  const ProcessResult plain = render({});
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_THAT(plain.out, Not(HasSubstr("approximated")));
  EXPECT_THAT(plain.err, Not(HasSubstr("--texture-filter")));
  EXPECT_FALSE(header().contains("vernier:textureFilter"));
  EXPECT_EQ(picture()["texture_filter"], "none");
  EXPECT_EQ(picture()["texture_mip_bytes"], 0);
  const Image unfiltered = read_image(folder_.file("a.exr"));
  ASSERT_EQ(render({"--texture-filter", "none"}).exit_code, 0);
  EXPECT_EQ(read_image(folder_.file("a.exr")).values, unfiltered.values);
}

TEST_F(TextureFilterFlag, SaysThatItApproximates) {
  const ProcessResult filtered = render({"--texture-filter", "mip:0.5"});
  ASSERT_EQ(filtered.exit_code, 0) << filtered.err;
  EXPECT_THAT(filtered.out, HasSubstr("+ textures approximated"));
  EXPECT_THAT(filtered.err, HasSubstr("(--texture-filter mip:0.5)"));
  EXPECT_EQ(header()["vernier:textureFilter"], "mip:0.5 (approximated)");
  EXPECT_THAT(header()["vernier:command"], HasSubstr("--texture-filter mip:0.5"));
  EXPECT_EQ(picture()["texture_filter"], "mip:0.5");
}

TEST_F(TextureFilterFlag, IsRefusedWhereItCannotBe) {
  const auto expect_refused = [&](const std::vector<std::string>& flags, const char* text) {
    const ProcessResult result = render(flags);
    EXPECT_EQ(result.exit_code, 2) << text;
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
  };
  expect_refused({"--texture-filter", "mips"}, "did you mean 'mip'?");
  expect_refused({"--texture-filter", "mip:x"}, "expected none, mip, or mip with a width in pixels");
  expect_refused({"--texture-filter", "mip:99"}, "an area 99 pixels wide; expected 0.1 to 16");
  expect_refused({"--texture-filter", "mip", "--integrator", "light"}, "reads textures at points");
  expect_refused({"--texture-filter", "mip", "--strict"},
                 "--strict asks for a scene that is honoured exactly");
}

TEST_F(TextureFilterFlag, IsPartOfWhatACheckpointIsOf) {
  const std::string checkpoint = folder_.file("c.ckpt");
  ASSERT_EQ(render({"--texture-filter", "mip", "--checkpoint", checkpoint}).exit_code, 0);
  const ProcessResult other = render({"--resume", checkpoint});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("texture-filter"));
  EXPECT_EQ(render({"--texture-filter", "mip", "--resume", checkpoint}).exit_code, 0);
}

}  // namespace
}  // namespace vernier::test
