// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/documented_fields.h"
#include "tests/support/html.h"
#include "tests/support/process.h"

namespace vernier {
namespace {

using nlohmann::json;
using test::cornell_box;
using test::run_vernier;
using testing::HasSubstr;

TEST(Report, HoldsWhatTheStatisticsHold) {
  const test::TemporaryFolder folder;
  const auto result =
      run_vernier({"render", cornell_box, "-o", folder.file("a.exr"), "--size", "24x16", "--spp", "64",
                   "--stats", folder.file("a.json"), "--report", folder.file("a.html"), "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.exr", "a.html", "a.json"}));
  const std::string page = test::read_file(folder.file("a.html"));
  const json stats = json::parse(test::read_file(folder.file("a.json")));
  EXPECT_EQ(json::parse(test::script_data(page, "stats")), stats);
  ASSERT_GE(stats["convergence"].size(), 2u);
  EXPECT_THAT(test::undocumented_fields(stats, "stats.md", {"built_with", "shares"}), testing::IsEmpty());

  const json over_time = json::parse(test::script_data(page, "chart-1"));
  const json over_samples = json::parse(test::script_data(page, "chart-2"));
  ASSERT_EQ(over_time["curves"][0]["points"].size(), stats["convergence"].size());
  for (size_t i = 0; i < stats["convergence"].size(); ++i) {
    const json& row = stats["convergence"][i];
    EXPECT_EQ(over_time["curves"][0]["points"][i], (json{row["seconds"], row["error"]["rel_rmse"]}));
    EXPECT_EQ(over_samples["curves"][0]["points"][i],
              (json{row["samples_per_pixel"], row["error"]["rel_rmse"]}));
    EXPECT_EQ(over_time["curves"][0]["band"][i], (json{row["error"]["low"], row["error"]["high"]}));
  }
}

TEST(Report, IsOneFileWithItsPictures) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(run_vernier({"render", cornell_box, "-o", folder.file("a.png"), "--size", "24x16", "--spp", "32",
                         "--report", folder.file("a.html"), "-q"})
                .exit_code,
            0);
  const std::string page = test::read_file(folder.file("a.html"));
  const auto pictures = test::inline_pictures(page);
  ASSERT_EQ(pictures.size(), 4u);  // picture, error, samples, pixels not to be trusted
  for (const auto& size : pictures) EXPECT_EQ(size, (std::pair<int, int>(24, 16)));
  EXPECT_TRUE(test::is_self_contained(page));
  EXPECT_THAT(page, HasSubstr("--size 24x16 --spp 32"));
  EXPECT_THAT(page, HasSubstr("ended by</th><td>all samples taken"));
}

TEST(Report, ShowsTheDenoisedPictureAndTheNoisyOne) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(run_vernier({"render", cornell_box, "-o", folder.file("a.png"), "--size", "24x16", "--spp", "32",
                         "--denoise", "nlm", "--stats", folder.file("a.json"), "--report",
                         folder.file("a.html"), "-q"})
                .exit_code,
            0);
  const std::string page = test::read_file(folder.file("a.html"));
  EXPECT_EQ(test::inline_pictures(page).size(), 6u);  // one more picture, and one more map of its error
  const json stats = json::parse(test::read_file(folder.file("a.json")));
  EXPECT_THAT(test::undocumented_fields(stats["denoised"], "stats.md"), testing::IsEmpty());
  const auto percent = [](double part) { return fmt::format("{:.3g} %", 100 * part); };
  EXPECT_THAT(page, HasSubstr("Denoised by nlm: estimated error " + percent(stats["denoised"]["rel_rmse"])));
  EXPECT_THAT(page, HasSubstr("As rendered: estimated error " + percent(stats["error"]["rel_rmse"])));
}

TEST(Report, SaysWhatWasAskedForAndMissed) {
  const test::TemporaryFolder folder;
  const auto result =
      run_vernier({"render", cornell_box, "-o", folder.file("a.png"), "--size", "24x16", "--spp", "16",
                   "--error", "0.1%", "--stats", folder.file("a.json"), "--report", folder.file("a.html")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("; all samples were taken before the error of 0.1 %\n"));
  const std::string page = test::read_file(folder.file("a.html"));
  EXPECT_THAT(page, HasSubstr("ended by</th><td>all samples taken, before the error of 0.1 %"));
  // One look makes no curve, and the same number of samples everywhere no map.
  EXPECT_THAT(page, testing::Not(HasSubstr("<canvas")));
  EXPECT_EQ(test::inline_pictures(page).size(), 3u);
  const json asked = json::parse(test::read_file(folder.file("a.json")))["picture"]["asked"];
  EXPECT_EQ(asked, (json{{"samples_per_pixel", 16}, {"seconds", nullptr}, {"rel_rmse", 0.001}}));
}

TEST(Report, NamesCannotBreakThePage) {
  const test::TemporaryFolder folder;
  const std::string scene = folder.write("<script> & \xff.gltf", R"({"asset": {"version": "2.0"}})");
  ASSERT_EQ(run_vernier({"render", scene, "-o", folder.file("a.png"), "--size", "8x8", "--spp", "1",
                         "--report", folder.file("a.html"), "-q"})
                .exit_code,
            0);
  const std::string page = test::read_file(folder.file("a.html"));
  EXPECT_THAT(page, HasSubstr("Render of &lt;script&gt; &amp;"));
  EXPECT_THAT(page, testing::Not(HasSubstr("<script> & ")));
  EXPECT_EQ(json::parse(test::script_data(page, "stats"))["picture"]["samples"], 64);
  EXPECT_THAT(page, HasSubstr("Warnings and notes"));
  EXPECT_THAT(page, HasSubstr("nothing to see"));
}

TEST(Report, IsRefusedBeforeRenderingWhereItCannotBeWritten) {
  const test::TemporaryFolder folder;
  const auto result = run_vernier({"render", cornell_box, "-o", folder.file("a.png"), "--report",
                                   folder.file("nowhere/a.html"), "--size", "8x8"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("nowhere/a.html"));
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace vernier
