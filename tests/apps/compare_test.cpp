// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/image/image_io.h"
#include "tests/support/process.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int done = 0, comparison_failed = 1, usage = 2, input = 3;

// A 4x3 picture of one value, but for one pixel.
Image picture(float value, float green_at_2_1) {
  Image image(4, 3, 3);
  std::fill(image.values.begin(), image.values.end(), value);
  image.pixel(2, 1)[1] = green_at_2_1;
  return image;
}

class Compare : public testing::Test {
 protected:
  Compare() {
    write_exr(a_, picture(0.5f, 0.5f), {"R", "G", "B"}, {});
    write_exr(b_, picture(0.5f, 2.f), {"R", "G", "B"}, {});
  }
  ProcessResult compare(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "compare");
    return run_vernier(arguments);
  }

  TemporaryFolder folder_;
  std::string a_ = folder_.file("a.exr"), b_ = folder_.file("b.exr");
};

TEST_F(Compare, JsonHasEveryFigure) {
  const ProcessResult result = compare({a_, b_, "--json"});
  ASSERT_EQ(result.exit_code, done) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report["width"], 4);
  EXPECT_EQ(report["height"], 3);
  EXPECT_EQ(report["relmse_epsilon"], 0.01);
  EXPECT_NEAR(report["metrics"]["mse"], 2.25 / 36, 1e-12);
  EXPECT_NEAR(report["metrics"]["rmse"], std::sqrt(2.25 / 36), 1e-12);
  EXPECT_NEAR(report["metrics"]["relmse"], 2.25 / 4.01 / 36, 1e-12);
  EXPECT_NEAR(report["metrics"]["mae"], 1.5 / 36, 1e-12);
  EXPECT_NEAR(report["metrics"]["psnr"], 10 * std::log10(4 / (2.25 / 36)), 1e-9);
  EXPECT_EQ(report["metrics"]["largest"], 1.5);
  EXPECT_EQ(report["metrics"]["not_finite"], 0);
  EXPECT_EQ(report["largest_at"], json::array({2, 1}));
  EXPECT_NEAR(report["reference_mean"][1], 0.625, 1e-12);
  EXPECT_EQ(report["failed"], json::array());
}

TEST_F(Compare, TextNamesEpsilonAndPlace) {
  const ProcessResult result = compare({a_, b_});
  EXPECT_EQ(result.exit_code, done);
  for (const char* text : {"mse", "relmse", "0.01", "4x3", "at (2, 1)", "psnr"})
    EXPECT_THAT(result.out, HasSubstr(text));
  EXPECT_EQ(result.err, "");
}

TEST_F(Compare, FailLimits) {
  EXPECT_EQ(compare({a_, b_, "--fail", "rmse>0.3"}).exit_code, done);
  const ProcessResult failed =
      compare({a_, b_, "--fail", "rmse>0.2", "--fail", "psnr<20", "--fail", "mae>1"});
  EXPECT_EQ(failed.exit_code, comparison_failed);
  ASSERT_EQ(failed.err_lines().size(), 2u) << failed.err;
  EXPECT_THAT(failed.err, HasSubstr("rmse is 0.25, above 0.2"));
  EXPECT_THAT(failed.err, HasSubstr("psnr is 18.0618, below 20"));
  const ProcessResult as_json = compare({a_, b_, "--json", "--fail=rmse>0.2"});
  EXPECT_EQ(as_json.exit_code, comparison_failed);
  EXPECT_EQ(json::parse(as_json.out)["failed"].size(), 1u);
  // Equal pictures have infinite decibels.
  EXPECT_EQ(compare({a_, a_, "--fail", "psnr<99", "--fail", "mse>0"}).exit_code, done);
  EXPECT_TRUE(json::parse(compare({a_, a_, "--json"}).out)["metrics"]["psnr"].is_null());
}

TEST_F(Compare, NotFiniteValuesCanFail) {
  write_exr(folder_.file("n.exr"), picture(0.5f, std::nanf("")), {"R", "G", "B"}, {});
  const ProcessResult result = compare({folder_.file("n.exr"), a_, "--fail", "not_finite>0"});
  EXPECT_EQ(result.exit_code, comparison_failed);
}

TEST_F(Compare, DisplayPicturesCountFromOne) {
  Image8 grey(4, 3, 3);
  write_image8(folder_.file("a.png"), grey, {});
  grey.values.assign(grey.values.size(), 51);
  write_image8(folder_.file("b.png"), grey, {});
  const ProcessResult result = compare({folder_.file("a.png"), folder_.file("b.png"), "--json"});
  EXPECT_NEAR(json::parse(result.out)["metrics"]["psnr"], -20 * std::log10(0.2), 1e-5);
  EXPECT_EQ(json::parse(result.out)["psnr_peak"], 1);
}

TEST_F(Compare, FlipAndItsMap) {
  const std::string map = folder_.file("map.png");
  const json report = json::parse(compare({a_, b_, "--json", "--heatmap", map}).out);
  EXPECT_GT(report["metrics"]["flip"], 0.1);
  EXPECT_LE(report["metrics"]["flip"], 1);
  EXPECT_NEAR(report["flip"]["pixels_per_degree"], 67.02, 0.01);
  EXPECT_GE(report["flip"]["exposures"], 2);
  const Image picture = read_image(map);
  EXPECT_EQ(picture.width, 4);
  EXPECT_EQ(picture.height, 3);
  EXPECT_GT(rgb_at(picture, 2, 1).x, rgb_at(picture, 0, 0).x) << "brightest where the pictures differ";
  EXPECT_EQ(compare({a_, b_, "--fail", "flip>0.01"}).exit_code, comparison_failed);
  EXPECT_FALSE(json::parse(compare({a_, b_, "--json", "--no-flip"}).out)["metrics"].contains("flip"));
}

// 12x12 pictures with an error layer of 0.01 from 17 samples; one pixel is `shift` errors away.
std::string with_error(const TemporaryFolder& folder, const std::string& name, float shift) {
  Image image(12, 12, 6);
  for (int i = 0; i < 144; ++i)
    for (int c = 0; c < 6; ++c) image.values[size_t(6 * i + c)] = c < 3 ? 0.5f : 0.01f;
  image.pixel(7, 3)[1] += shift * 0.01f;
  write_exr(folder.file(name), image, {"R", "G", "B", "error.R", "error.G", "error.B"},
            {{"vernier:samplesPerPixel", "17"}});
  return folder.file(name);
}

TEST_F(Compare, BiasTestUsesBothErrorLayers) {
  const std::string base = with_error(folder_, "0.exr", 0), near = with_error(folder_, "3.exr", 3),
                    far = with_error(folder_, "20.exr", 20);
  const json same = json::parse(compare({base, near, "--json", "--bias-block", "1"}).out)["bias"];
  EXPECT_EQ(same["different"], false);
  EXPECT_EQ(same["blocks_tested"], 144);
  const ProcessResult failed = compare({base, far, "--json", "--bias-block=1", "--fail", "differing>0"});
  EXPECT_EQ(failed.exit_code, comparison_failed);
  const json bias = json::parse(failed.out)["bias"];
  EXPECT_EQ(bias["different"], true);
  EXPECT_EQ(bias["blocks_differing"], 1);
  EXPECT_EQ(bias["smallest_p_at"], json::array({7, 3}));
  // Student's t with 30 degrees of freedom, not the normal distribution: 20 / sqrt 2 errors have p = 1e-14,
  // times 3.
  EXPECT_GT(bias["smallest_p"], 1e-15);
  EXPECT_LT(bias["smallest_p"], 1e-12);
  EXPECT_THAT(compare({base, far, "--bias-block", "1"}).out, HasSubstr("different expectations"));
  EXPECT_EQ(json::parse(compare({base, far, "--json"}).out)["bias"]["blocks_tested"], 4);
  EXPECT_FALSE(json::parse(compare({a_, b_, "--json"}).out).contains("bias"));
}

TEST_F(Compare, UsageErrors) {
  write_exr(folder_.file("c.exr"), Image(3, 4, 3), {"R", "G", "B"}, {});
  write_image8(folder_.file("a.png"), Image8(4, 3, 3), {});
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{}, "missing X or R"},
      {{a_}, "missing X or R"},
      {{a_, b_, "--fail", "rmse"}, "METRIC>NUMBER"},
      {{a_, b_, "--fail", "rmse>x"}, "METRIC>NUMBER"},
      {{a_, b_, "--fail", "rmse>1x"}, "METRIC>NUMBER"},
      {{a_, b_, "--fail", "rmse>nan"}, "METRIC>NUMBER"},
      {{a_, b_, "--fail", "rmsee>1"}, "did you mean 'rmse'"},
      {{a_, folder_.file("c.exr")}, "4x3 and 3x4"},
      {{a_, folder_.file("a.png")}, "linear light"},
      {{a_, b_, "--fail", "differing>0"}, "no error layer"},
      {{a_, b_, "--no-flip", "--fail", "flip>0"}, "--no-flip was given"},
      {{a_, b_, "--no-flip", "--heatmap", "x.png"}, "drop one"},
      {{a_, b_, "--bias-level", "2"}, "--bias-level: '2' is not a number from"},
  };
  for (const auto& [arguments, text] : cases) {
    const ProcessResult result = compare(arguments);
    EXPECT_EQ(result.exit_code, usage) << text;
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
  }
}

TEST_F(Compare, UnwritableHeatmap) {
  const ProcessResult result = compare({a_, b_, "--heatmap", folder_.file("none/x.png")});
  EXPECT_EQ(result.exit_code, input);
  EXPECT_THAT(result.err, HasSubstr("does not exist"));
  EXPECT_EQ(compare({a_, b_, "--heatmap", folder_.file("x.gif")}).exit_code, input);
}

TEST_F(Compare, FilesThatCannotBeRead) {
  for (const std::string& bad :
       {folder_.file("none.exr"), folder_.path().string(), folder_.write("t.png", "text")}) {
    const ProcessResult result = compare({a_, bad});
    EXPECT_EQ(result.exit_code, input);
    EXPECT_THAT(result.err, HasSubstr(bad));
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
  }
}

}  // namespace
}  // namespace vernier::test
