// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image_io.h"
#include "tests/support/process.h"

namespace vernier::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Develop : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.file(name); }
  void render(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", cornell_box, "--size",     "48x32",
                                       "--spp",  "8",         "--progress", "none"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult result = run_vernier(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  TemporaryFolder folder_;
};

// The same picture as the render writes itself, whatever the view and exposure.
TEST_F(Develop, IsWhatRenderWrites) {
  for (const std::vector<std::string>& shown :
       {std::vector<std::string>{}, {"--view", "neu", "--exposure", "-1.5"}, {"--view", "raw"}}) {
    std::vector<std::string> rendered{"-o", file("a.exr"), "-o", file("a.png")};
    rendered.insert(rendered.end(), shown.begin(), shown.end());
    render(rendered);
    std::vector<std::string> arguments{"develop", file("a.exr"), "-o", file("b.png")};
    arguments.insert(arguments.end(), shown.begin(), shown.end());
    const ProcessResult result = run_vernier(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("48x32, view "));
    EXPECT_EQ(read_image(file("a.png")).values, read_image(file("b.png")).values);
  }
}

TEST_F(Develop, ShowsLayersAndDenoises) {
  render({"-o", file("a.exr"), "--aov", "error,half,albedo,normal,depth"});
  for (const std::string layer : {"albedo", "Z", "N"}) {
    ASSERT_EQ(run_vernier({"develop", file("a.exr"), "-o", file(layer + ".exr"), "--layer", layer}).exit_code,
              0);
    const LayeredImage all = read_layers(file("a.exr"));
    const auto color = all.layer(layer);
    EXPECT_EQ(read_image(file(layer + ".exr")).values[5],
              color ? color->values[5] : all.single(layer)->values[1])
        << layer;
  }
  const ProcessResult denoised =
      run_vernier({"develop", file("a.exr"), "-o", file("d.png"), "--denoise", "nlm"});
  EXPECT_THAT(denoised.out, HasSubstr("denoised by nlm: error "));
  ASSERT_EQ(run_vernier({"denoise", file("a.exr"), "-o", file("e.png"), "--filter", "nlm"}).exit_code, 0);
  EXPECT_EQ(read_image(file("d.png")).values, read_image(file("e.png")).values);
}

TEST_F(Develop, SaysWhatIsMissingOrWrong) {
  render({"-o", file("a.exr"), "-o", file("a.png")});
  const auto error = [&](const std::vector<std::string>& arguments, int code) {
    const ProcessResult result = run_vernier(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    return result.err;
  };
  EXPECT_THAT(run_vernier({"develop", "--denoise", "help"}).out, HasSubstr("nlm"));
  EXPECT_THAT(error({"develop"}, 2), HasSubstr("missing IN"));
  EXPECT_THAT(error({"develop", file("a.exr")}, 2), HasSubstr("missing -o FILE"));
  EXPECT_THAT(error({"develop", file("a.png"), "-o", file("b.png")}, 3), HasSubstr("display values already"));
  EXPECT_THAT(error({"develop", file("a.exr"), "-o", file("b.png"), "--layer", "depth"}, 2),
              AllOf(HasSubstr("no layer 'depth'"), HasSubstr("R, G, B")));
  EXPECT_THAT(error({"develop", file("a.exr"), "-o", file("b.png"), "--view", "filmic"}, 2),
              HasSubstr("ACES SDR"));
  EXPECT_THAT(error({"develop", file("a.exr"), "-o", file("a.exr")}, 2), HasSubstr("a.exr"));
}

}  // namespace
}  // namespace vernier::test
