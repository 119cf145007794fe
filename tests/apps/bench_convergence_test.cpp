// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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

test::ProcessResult bench(std::vector<std::string> more) {
  more.insert(more.begin(), {"bench", "convergence"});
  return run_vernier(more);
}

TEST(BenchConvergence, PageTableAndDataAgree) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("deep/out");
  const auto result = bench({cornell_box, "--integrator", "path,whitted", "--times", "0.1,0.04", "--seeds",
                             "2", "--size", "20x20", "--reference-spp", "1024", "--out", out});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(test::read_file(out + "/convergence.json"));
  const std::string page = test::read_file(out + "/convergence.html");
  const std::string csv = test::read_file(out + "/convergence.csv");
  EXPECT_EQ(json::parse(test::script_data(page, "convergence")), report);
  EXPECT_TRUE(test::is_self_contained(page));
  json own = report;
  own["scenes"][0].erase("counts");  // as in stats.md
  EXPECT_THAT(test::undocumented_fields(own, "bench.md", {"built_with", "machine"}), testing::IsEmpty());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 2 * 2);

  const json& scene = report["scenes"][0];
  ASSERT_EQ(scene["candidates"].size(), 2u);
  const json over_time = json::parse(test::script_data(page, "chart-1"));
  for (size_t c = 0; c < 2; ++c) {
    const json& points = scene["candidates"][c]["points"];
    ASSERT_EQ(points.size(), 2u);
    EXPECT_LT(points[0]["asked_seconds"], points[1]["asked_seconds"]);
    for (size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(over_time["curves"][c]["points"][i],
                (json{points[i]["seconds"], points[i]["rel_rmse"]["median"]}));
      EXPECT_THAT(csv, HasSubstr(points[i]["runs"][1]["rel_rmse"].dump()));
    }
  }
  // Reference; a map and a crop of each candidate, and of the reference.
  EXPECT_EQ(test::inline_pictures(page).size(), 6u);
}

TEST(BenchConvergence, BiasFlattensTheCurve) {
  const test::TemporaryFolder folder;
  const auto result = bench({cornell_box, "--integrator", "path,whitted", "--times", "0.05,0.2", "--seeds",
                             "2", "--size", "12x12", "--reference-spp", "8192", "--out", folder.file("out")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(test::read_file(folder.file("out/convergence.json")));
  const json &path = report["scenes"][0]["candidates"][0], &whitted = report["scenes"][0]["candidates"][1];
  // Whitted lacks interreflection; its noise has gone long before.
  const double error = whitted["points"].back()["rel_rmse"]["median"];
  EXPECT_NEAR(whitted["systematic"].get<double>(), error, 0.1 * error);
  EXPECT_LT(path["systematic"].get<double>(), error);
}

// Two samples a pixel are taken however short the time is.
TEST(BenchConvergence, TimesTooShortForMoreSamplesHaveNoSlope) {
  const test::TemporaryFolder folder;
  const auto result = bench({cornell_box, "--times", "0.000001,0.000002,0.000002", "--seeds", "1", "--size",
                             "12x12", "--reference-spp", "64", "--out", folder.file("out")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(test::read_file(folder.file("out/convergence.json")));
  EXPECT_EQ(report["times"].size(), 2u);
  EXPECT_EQ(report["scenes"][0]["candidates"][0]["accelerator"], "list") << "as a render takes";
  EXPECT_TRUE(report["scenes"][0]["candidates"][0]["fit"].is_null());
}

TEST(BenchConvergence, FilesAreLookedAtBeforeAnythingIsMeasured) {
  const test::TemporaryFolder folder;
  const auto missing = bench({cornell_box, folder.file("none.glb"), "--out", folder.file("out")});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err_lines(), testing::ElementsAre(HasSubstr("none.glb: cannot be read: No such file")));
  ASSERT_EQ(
      run_vernier({"render", cornell_box, "-o", folder.file("a.png"), "--size", "8x8", "--spp", "1", "-q"})
          .exit_code,
      0);
  const auto display = bench({cornell_box, "--reference", folder.file("a.png"), "--out", folder.file("out")});
  EXPECT_EQ(display.exit_code, 3);
  EXPECT_THAT(display.err_lines(),
              testing::ElementsAre(HasSubstr("a.png: holds display values; expected a scene-linear")));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.png"});
}

TEST(BenchConvergence, MisuseIsOneClearLine) {
  const test::TemporaryFolder folder;
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& text) {
    const auto result = bench(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_TRUE(folder.names().empty());
  };
  const std::string out = folder.file("out");
  refused({"--out", out}, "missing SCENES");
  refused({cornell_box}, "missing --out DIR");
  refused({cornell_box, "--out", out, "--integrator", "pth"}, "did you mean 'path'?");
  refused({cornell_box, "--out", out, "--times", "1,soon"}, "'soon' is not a duration");
  refused({cornell_box, cornell_box, "--out", out, "--reference", "a.exr"}, "2 scenes and 1 references");
}

}  // namespace
}  // namespace vernier
