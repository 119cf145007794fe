// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/compare/metrics.h"
#include "core/image/image_io.h"
#include "tests/support/process.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

class MergeCommand : public testing::Test {
 protected:
  /// Renders NAME.exr and NAME.ckpt.
  void render(const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render",
                                       cornell_box,
                                       "-q",
                                       "-o",
                                       folder_.file(name + ".exr"),
                                       "--checkpoint",
                                       folder_.file(name + ".ckpt"),
                                       "--aov",
                                       "error,half,samples"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_EQ(run_vernier(arguments).exit_code, 0);
  }
  ProcessResult merge(const std::vector<std::string>& names, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"merge", "-o", folder_.file("merged.exr")};
    for (const auto& name : names) arguments.push_back(folder_.file(name + ".ckpt"));
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_vernier(arguments);
  }
  LayeredImage layers(const std::string& name) { return read_layers(folder_.file(name + ".exr")); }

  const TemporaryFolder folder_;
};

TEST_F(MergeCommand, ShowsThePictureThatItWouldWrite) {
  render("a", {"--size", "32x32", "--spp", "8", "--seed", "1"});
  render("b", {"--size", "32x32", "--spp", "8", "--seed", "2"});
  ASSERT_EQ(merge({"a", "b"}).exit_code, 0);
  const std::string shown = folder_.file("shown.png"), developed = folder_.file("developed.png");
  ASSERT_EQ(run_vernier({"merge", folder_.file("a.ckpt"), folder_.file("b.ckpt"), "-o", shown}).exit_code, 0);
  ASSERT_EQ(run_vernier({"develop", folder_.file("merged.exr"), "-o", developed}).exit_code, 0);
  EXPECT_EQ(read_image(shown).values, read_image(developed).values);
}

TEST_F(MergeCommand, AllSamplesCount) {
  const std::vector<std::string> names{"a", "b", "c"};
  for (size_t i = 0; i < 3; ++i)
    render(names[i], {"--size", "48x48", "--spp", "40", "--seed", std::to_string(i + 1)});
  const ProcessResult result = merge(names, {"--aov", "error,half,samples"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("spp of 3 renders, error "));
  const LayeredImage merged = layers("merged");
  EXPECT_EQ(merged.metadata.at("vernier:seed"), "1 2 3");
  double samples = 0;
  Image sum(48, 48, 1), half_sum(48, 48, 3);
  for (const auto& name : names) {
    const LayeredImage part = layers(name);
    samples += std::stod(part.metadata.at("vernier:samples"));
    const Image counts = *part.single("samples"), half = *part.layer("half2");
    for (size_t i = 0; i < sum.values.size(); ++i) {
      sum.values[i] += counts.values[i];
      for (size_t c = 0; c < 3; ++c) half_sum.values[3 * i + c] += half.values[3 * i + c] / 3;
    }
    // A third of the variance, less what adaptive sampling and the estimate scatter.
    const double before = std::stod(part.metadata.at("vernier:relRmse"));
    EXPECT_NEAR(std::stod(merged.metadata.at("vernier:relRmse")) / before, std::sqrt(1.0 / 3), 0.08);
  }
  EXPECT_EQ(std::stod(merged.metadata.at("vernier:samples")), samples);
  EXPECT_EQ(merged.single("samples")->values, sum.values);
  // The second halves went to the second half: its mean is theirs but for the weights by samples.
  const Image half = *merged.layer("half2"), other = *merged.layer("half1");
  EXPECT_LT(difference(half, half_sum).rel_mse, 0.1 * difference(other, half_sum).rel_mse);
}

TEST_F(MergeCommand, PartsHaveOneExpectationWithTheWhole) {
  render("a", {"--size", "64x64", "--spp", "64", "--seed", "1"});
  render("b", {"--size", "64x64", "--spp", "64", "--seed", "2"});
  render("r", {"--size", "64x64", "--spp", "256", "--seed", "3"});
  ASSERT_EQ(merge({"a", "b"}, {"--aov", "error"}).exit_code, 0);
  const ProcessResult compared = run_vernier({"compare", folder_.file("merged.exr"), folder_.file("r.exr"),
                                              "--fail", "differing>0", "--fail", "mean_p<0.001"});
  EXPECT_EQ(compared.exit_code, 0) << compared.out;
}

TEST_F(MergeCommand, WhatIsMissingIsNamed) {
  render("a", {"--size", "16x16", "--spp", "2", "--seed", "1"});
  render("b", {"--size", "16x16", "--spp", "2", "--seed", "2"});
  const ProcessResult refused = merge({"a", "x", "b", "y"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("2 of 4 checkpoints are not there: " + folder_.file("x.ckpt") + ", " +
                                     folder_.file("y.ckpt") + "; render them"));
  EXPECT_THAT(folder_.names(), testing::Not(testing::Contains(HasSubstr("merged"))));
  const ProcessResult told = merge({"a", "x", "b", "y"}, {"--skip-missing"});
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_THAT(told.err, testing::StartsWith("warning: 2 of 4 checkpoints are not there"));
  const std::vector<float> without = layers("merged").image.values;
  EXPECT_EQ(merge({"a", "b"}).exit_code, 0);
  EXPECT_EQ(layers("merged").image.values, without);
  EXPECT_EQ(merge({"x", "y"}, {"--skip-missing"}).exit_code, 3);
  // One of two is a picture, too.
  EXPECT_EQ(merge({"a", "x"}, {"--skip-missing"}).exit_code, 0);
}

TEST_F(MergeCommand, SaysWhatAnErrorNeeds) {
  render("a", {"--size", "32x32", "--spp", "16", "--seed", "1"});
  render("b", {"--size", "32x32", "--spp", "16", "--seed", "2"});
  const std::string goal = folder_.file("goal");
  const auto goal_for = [&](const std::string& error) {
    const ProcessResult result = merge({"a", "b"}, {"--error", error, "--goal", goal});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out.find("needs about " + read_file(goal).substr(0, 2)) != std::string::npos,
              read_file(goal) != "0\n");
    return std::stoi(read_file(goal));
  };
  EXPECT_EQ(goal_for("99%"), 0);
  // Half the error takes four times the samples.
  EXPECT_GT(goal_for("4%"), 32);
  EXPECT_NEAR(double(goal_for("2%")) / goal_for("4%"), 4, 0.1);
  EXPECT_EQ(merge({"a", "b"}, {"--goal", goal}).exit_code, 2);
}

TEST_F(MergeCommand, SeveralOutputs) {
  render("a", {"--size", "16x16", "--spp", "2", "--seed", "1"});
  render("b", {"--size", "16x16", "--spp", "2", "--seed", "2"});
  const ProcessResult result = merge({"a", "b"}, {"-o", folder_.file("merged.png"), "--aov", "error"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(folder_.names(), testing::IsSupersetOf({"merged.exr", "merged.png"}));
}

// What the parts leave out the whole leaves out, too.
TEST_F(MergeCommand, MissingLightIsToldOf) {
  for (const char* seed : {"1", "2"})
    render(seed, {"--size", "16x16", "--spp", "64", "--max-depth", "2", "--seed", seed});
  const ProcessResult result = merge({"1", "2"});
  EXPECT_THAT(result.out, HasSubstr("of all light missing beyond the depth limit"));
  const auto missing = [&](const std::string& name) {
    return std::stod(layers(name).metadata.at("vernier:missingBeyondDepth"));
  };
  EXPECT_NEAR(missing("merged"), (missing("1") + missing("2")) / 2, 0.02);
}

TEST_F(MergeCommand, Refuses) {
  render("a", {"--size", "16x16", "--spp", "2", "--seed", "1"});
  render("same", {"--size", "16x16", "--spp", "4", "--seed", "1"});
  render("larger", {"--size", "24x16", "--spp", "2", "--seed", "2"});
  const ProcessResult same = merge({"a", "same"});
  EXPECT_EQ(same.exit_code, 3);
  EXPECT_THAT(same.err, HasSubstr("same.ckpt: has the seed 1 of " + folder_.file("a.ckpt")));
  const ProcessResult larger = merge({"a", "larger"});
  EXPECT_EQ(larger.exit_code, 3);
  EXPECT_THAT(larger.err, HasSubstr("size was 24x16, is 16x16"));
  EXPECT_EQ(merge({"a"}).exit_code, 2);
  EXPECT_EQ(merge({"a", "none"}).exit_code, 3);
  const ProcessResult albedo = merge({"a", "larger"}, {"--aov", "albedo"});
  EXPECT_EQ(albedo.exit_code, 2);
  EXPECT_THAT(albedo.err, HasSubstr("albedo is looked up in the scene"));
  EXPECT_EQ(run_vernier({"merge", folder_.file("a.ckpt"), folder_.file("larger.ckpt"), "-o",
                         folder_.file("merged.png")})
                .exit_code,
            3);
  EXPECT_EQ(run_vernier({"merge", folder_.file("a.ckpt"), folder_.file("larger.ckpt"), "--aov", "error", "-o",
                         folder_.file("merged.png")})
                .exit_code,
            2);
  EXPECT_THAT(folder_.names(), testing::Not(testing::Contains(HasSubstr("merged"))));
}

}  // namespace
}  // namespace vernier::test
