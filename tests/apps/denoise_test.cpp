// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/compare/metrics.h"
#include "core/denoise/denoise.h"
#include "core/image/image_io.h"
#include "tests/support/process.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

class DenoiseCommand : public testing::Test {
 protected:
  ProcessResult render(const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", cornell_box, "--progress", "none", "--size", "64x64"};
    arguments.insert(arguments.end(), {"-o", folder_.file(name)});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_vernier(arguments);
  }
  ProcessResult denoise(const std::string& from, const std::string& to,
                        const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"denoise", folder_.file(from), "-o", folder_.file(to)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_vernier(arguments);
  }
  TemporaryFolder folder_;
};

/// True relative RMSE over what the error layer says of it.
double error_factor(const LayeredImage& file, const Image& truth) {
  const Image picture = file.rgb(), error = *file.layer("error");
  double off = 0, told = 0;
  for (size_t i = 0; i < truth.values.size(); ++i) {
    const double r = truth.values[i], weight = 1 / (r * r + 0.01);
    off += weight * (picture.values[i] - r) * (picture.values[i] - r);
    told += weight * error.values[i] * error.values[i];
  }
  return std::sqrt(off / told);
}

TEST_F(DenoiseCommand, EveryFilterLowersTheErrorAndSaysSo) {
  ASSERT_EQ(render("noisy.exr", {"--spp", "8", "--aov", "error,half,albedo,normal"}).exit_code, 0);
  ASSERT_EQ(render("truth.exr", {"--spp", "192", "--seed", "5"}).exit_code, 0);
  const Image truth = read_image(folder_.file("truth.exr")), noisy = read_image(folder_.file("noisy.exr"));
  const double before = difference(noisy, truth).rel_mse;
  for (const Denoiser& denoiser : denoisers()) {
    const ProcessResult result = denoise("noisy.exr", "a.exr", {"--filter", std::string(denoiser.name)});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("denoised by " + std::string(denoiser.name) + ": error "));
    const LayeredImage file = read_layers(folder_.file("a.exr"));
    const double after = difference(file.rgb(), truth).rel_mse;
    EXPECT_LT(after, before / 1.5) << denoiser.name;
    EXPECT_EQ(file.metadata.at("vernier:denoiser"), denoiser.name);
    EXPECT_TRUE(file.layer("error"));
    EXPECT_TRUE(file.single("error.unreliable"));
    EXPECT_EQ(file.channel_names.size(), 7u);
    EXPECT_LT(error_factor(file, truth), 1.5) << denoiser.name;
    EXPECT_GT(error_factor(file, truth), 0.6) << denoiser.name;
    EXPECT_THAT(file.metadata.at("vernier:denoiseCommand"), HasSubstr("denoise"));
  }
}

TEST_F(DenoiseCommand, RenderDoesTheSame) {
  const ProcessResult plain =
      render("noisy.exr", {"--spp", "8", "--aov", "error,half,albedo,normal,coverage"});
  const ProcessResult result = render("a.exr", {"--spp", "8", "--denoise", "nlm", "-o", folder_.file("a.png"),
                                                "--stats", folder_.file("s.json")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("denoised by nlm: error "));
  EXPECT_THAT(plain.out, testing::Not(HasSubstr("denoised")));
  ASSERT_EQ(denoise("noisy.exr", "b.exr", {"--filter", "nlm", "--threads", "1"}).exit_code, 0);
  const LayeredImage rendered = read_layers(folder_.file("a.exr"));
  const Image denoised = read_image(folder_.file("b.exr")), noisy = read_image(folder_.file("noisy.exr"));
  EXPECT_EQ(rendered.rgb().values, denoised.values);
  EXPECT_NE(rendered.rgb().values, noisy.values);
  EXPECT_TRUE(rendered.layer("half1")) << "what it was made from is still there";
  const LayeredImage noisy_file = read_layers(folder_.file("noisy.exr"));
  EXPECT_EQ(rendered.layer("noisyError")->values, noisy_file.layer("error")->values);
  EXPECT_EQ(rendered.layer("error")->values, read_layers(folder_.file("b.exr")).layer("error")->values);
  const auto stats = nlohmann::json::parse(read_file(folder_.file("s.json")));
  EXPECT_EQ(stats["denoised"]["filter"], "nlm");
  EXPECT_LT(stats["denoised"]["rel_rmse"], stats["denoised"]["rel_rmse_before"]);
}

// Two denoised pictures of one scene differ by no more than they tell, and nor does one from the truth:
// errors that go together do not make squares of pixels seem different.
TEST_F(DenoiseCommand, CompareKnowsWhatTheErrorIs) {
  const std::vector<std::string> bias{"--fail", "differing>0", "--fail", "mean_p<0.01"};
  const auto compare = [&](const std::string& a, const std::string& b) {
    return run_vernier({"compare", folder_.file(a), folder_.file(b), bias[0], bias[1], bias[2], bias[3]});
  };
  ASSERT_EQ(render("a.exr", {"--spp", "16", "--denoise", "nlm"}).exit_code, 0);
  ASSERT_EQ(render("b.exr", {"--spp", "16", "--denoise", "nlm", "--seed", "3"}).exit_code, 0);
  ASSERT_EQ(render("truth.exr", {"--spp", "192", "--seed", "5", "--aov", "error"}).exit_code, 0);
  ASSERT_EQ(
      render("bright.exr", {"--spp", "16", "--seed", "7", "--denoise", "nlm", "--integrator", "whitted"})
          .exit_code,
      0);
  const ProcessResult two = compare("a.exr", "b.exr"), truth = compare("a.exr", "truth.exr");
  EXPECT_EQ(two.exit_code, 0) << two.out;
  EXPECT_THAT(two.out, HasSubstr("errors after denoising"));
  EXPECT_EQ(truth.exit_code, 0) << truth.out;
  const ProcessResult other = compare("bright.exr", "truth.exr");
  EXPECT_EQ(other.exit_code, 1) << other.out;
}

TEST_F(DenoiseCommand, OnePictureAloneHasNoErrorToTell) {
  ASSERT_EQ(render("noisy.exr", {"--spp", "16"}).exit_code, 0);
  const ProcessResult result = denoise("noisy.exr", "a.exr");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("not known"));
  ASSERT_EQ(render("halfless.exr", {"--spp", "16", "--aov", "error"}).exit_code, 0);
  ASSERT_EQ(denoise("halfless.exr", "b.exr").exit_code, 0);
  EXPECT_FALSE(read_layers(folder_.file("b.exr")).layer("error")) << "the noisy one's is not its own";
  // With one sample a pixel the second half is empty, and the picture not the mean of the two.
  ASSERT_EQ(render("one.exr", {"--spp", "1", "--denoise", "gaussian"}).exit_code, 0);
  ASSERT_EQ(render("raw.exr", {"--spp", "1"}).exit_code, 0);
  const Image denoised = read_image(folder_.file("one.exr")), raw = read_image(folder_.file("raw.exr"));
  double sum = 0, expected = 0;
  for (size_t i = 0; i < raw.values.size(); ++i) {
    sum += denoised.values[i];
    expected += raw.values[i];
  }
  EXPECT_NEAR(sum / expected, 1, 0.2);
}

TEST_F(DenoiseCommand, UsageErrors) {
  write_exr(folder_.file("a.exr"), Image(4, 4, 3), {"R", "G", "B"}, {});
  write_image8(folder_.file("a.png"), Image8(4, 4, 3), {});
  EXPECT_EQ(run_vernier({"denoise"}).exit_code, 2);
  EXPECT_EQ(run_vernier({"denoise", folder_.file("a.exr")}).exit_code, 2);
  const ProcessResult unknown = denoise("a.exr", "b.exr", {"--filter", "bilatral"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'bilateral'"));
  setenv("VERNIER_OIDN", folder_.file("missing.so").c_str(), 1);
  const ProcessResult absent = denoise("a.exr", "b.exr", {"--filter", "oidn"});
  const ProcessResult instead = denoise("a.exr", "b.exr", {"--filter", "auto"});
  setenv("VERNIER_OIDN", "", 1);
  EXPECT_EQ(denoise("a.exr", "a.exr", {"--filter", "auto"}).exit_code, 0);
  unsetenv("VERNIER_OIDN");
  EXPECT_EQ(instead.exit_code, 2) << "it was named";
  EXPECT_EQ(absent.exit_code, 2);
  EXPECT_THAT(absent.err, HasSubstr("no filter 'oidn' here: VERNIER_OIDN: " + folder_.file("missing.so")));
  EXPECT_EQ(denoise("a.exr", "b.png", {"--view", "filmic"}).exit_code, 2);
  EXPECT_EQ(denoise("a.png", "b.exr").exit_code, 3);
  EXPECT_EQ(denoise("missing.exr", "b.exr").exit_code, 3);
  EXPECT_EQ(run_vernier({"denoise", "--filter", "help"}).exit_code, 0);
  EXPECT_EQ(run_vernier({"render", "--denoise", "help"}).exit_code, 0);
  EXPECT_EQ(render("c.exr", {"--denoise", "bilatral"}).exit_code, 2);
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a.exr", "a.png"}));
}

}  // namespace
}  // namespace vernier::test
