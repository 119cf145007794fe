// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/process.h"

namespace vernier {
namespace {

using nlohmann::json;
using test::cornell_box;
using testing::HasSubstr;

constexpr int done = 0, usage = 2, input = 3;

TEST(BenchRays, TimesAcceleratorsBesideEmbree) {
  test::TemporaryFolder folder;
  const std::string file = folder.file("rays.json");
  const auto result = test::run_vernier({"bench", "rays", cornell_box, "--accelerator", "bvh,octree",
                                         "--paths", "500", "--repetitions", "2", "--json", file});
  ASSERT_EQ(result.exit_code, done) << result.err;
  EXPECT_THAT(result.out, HasSubstr("bvh"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr("brute_force")));
  const auto report = json::parse(test::read_file(file));
  ASSERT_EQ(report["accelerators"].size(), 3u);
  EXPECT_GE(report["rays"]["bounce"], report["rays"]["primary"]);
  for (const auto& accelerator : report["accelerators"]) {
    EXPECT_GT(accelerator["build_seconds"], 0);
    for (const std::string threads : {"one_thread", "all_threads"})
      for (const std::string kind : {"primary", "bounce", "shadow", "mixed"}) {
        const auto& rate = accelerator["rays_per_second"][threads][kind];
        EXPECT_GT(rate["median"], 0) << threads << kind;
        if (accelerator["name"] == "embree") {
          EXPECT_EQ(rate["ratio_to_embree"], 1);
        }
      }
    EXPECT_EQ(accelerator["name"] != "embree", accelerator.contains("per_ray")) << accelerator["name"];
  }
}

TEST(BenchStability, WritesTheTableAsJsonAndMarkdown) {
  test::TemporaryFolder folder;
  const std::string file = folder.file("s.json"), table = folder.file("s.md");
  const auto result =
      test::run_vernier({"bench", "stability", "--rays", "2000", "--accelerator", "bvh,embree-fast",
                         "--cases", "edge-100,gap,largest-size", "--json", file, "--markdown", table});
  ASSERT_EQ(result.exit_code, done) << result.err;
  EXPECT_THAT(result.out, HasSubstr("edge-100"));
  const auto report = json::parse(test::read_file(file));
  ASSERT_EQ(report["cases"].size(), 3u);
  const auto& edge = report["cases"][0]["accelerators"];
  EXPECT_EQ(edge["bvh"]["events"], 0);
  EXPECT_EQ(edge["bvh"]["trials"], 2000);
  EXPECT_GT(edge["embree-fast"]["value"], 10'000);
  EXPECT_EQ(report["cases"][1]["accelerators"]["bvh"]["value"], 16);
  EXPECT_THAT(test::read_file(table), HasSubstr("| case | figure | rays | bvh | embree-fast |"));
}

double sum_of(const json& rows, const char* key) {
  double sum = 0;
  for (const json& row : rows) sum += row[key].get<double>();
  return sum;
}

TEST(BenchProfile, TellsWhereTimeAndVarianceGo) {
  test::TemporaryFolder folder;
  const std::string file = folder.file("p.json");
  const auto result = test::run_vernier(
      {"bench", "profile", cornell_box, "--size", "48x48", "--spp", "8", "--max-depth", "5", "--json", file});
  ASSERT_EQ(result.exit_code, done) << result.err;
  EXPECT_THAT(result.out, HasSubstr("part of the variance"));
  const auto report = json::parse(test::read_file(file));
  const json& time = report["time"];
  EXPECT_NEAR(sum_of(time, "share"), 1, 1e-9);
  EXPECT_EQ(time[0]["kind"], "closest");
  EXPECT_GT(time[0]["a_sample"], 2);
  EXPECT_GT(time[0]["met"], 0.7) << "one side of the box is open";
  EXPECT_GT(time[0]["blocks"], 1);
  EXPECT_EQ(time[1]["kind"], "occlusion");
  EXPECT_GT(time[1]["met"], 0.02) << "boxes cast shadows";
  EXPECT_LT(time[1]["met"], 0.5);
  EXPECT_EQ(time.back()["kind"], "rest");
  const json& depth = report["depth"];
  ASSERT_EQ(depth.size(), 5u);
  EXPECT_EQ(depth[4]["max_depth"], 5);
  EXPECT_GT(depth[4]["relative_variance_trim"], 4 * depth[1]["relative_variance_trim"].get<double>());
  EXPECT_NEAR(sum_of(report["materials"], "pixels"), 1, 1e-9);
  EXPECT_NEAR(sum_of(report["materials"], "share"), 1, 1e-9);
  const auto own = test::run_vernier({"bench", "profile", cornell_box, "--size", "48x48", "--spp", "8",
                                      "--max-depth", "5", "--accelerator", "bvh", "--json", file});
  ASSERT_EQ(own.exit_code, done) << own.err;
  const auto of_bvh = json::parse(test::read_file(file));
  EXPECT_EQ(of_bvh["accelerator"], "bvh");
  EXPECT_NEAR(of_bvh["time"][0]["a_sample"], time[0]["a_sample"].get<double>(), 0.01);
  const auto unknown = test::run_vernier({"bench", "profile", cornell_box, "--accelerator", "bhv"});
  EXPECT_EQ(unknown.exit_code, usage);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'bvh'"));
}

TEST(BenchScale, TellsWhatBuildingAndRenderingCostAsScenesGrow) {
  test::TemporaryFolder folder;
  const std::string file = folder.file("s.json");
  const auto result = test::run_vernier(
      {"bench", "scale", "--axis", "instances,lights,depth", "--largest", "100", "--json", file});
  ASSERT_EQ(result.exit_code, done) << result.err;
  EXPECT_THAT(result.out, HasSubstr("ns a sample"));
  const auto report = json::parse(test::read_file(file));
  ASSERT_EQ(report["axes"].size(), 3u);
  EXPECT_EQ(report["axes"][0]["name"], "instances");
  EXPECT_EQ(report["axes"][0]["points"].size(), 2u);
  for (const auto& axis : report["axes"])
    for (const auto& point : axis["points"]) {
      EXPECT_GT(point["build"]["processor_seconds"], 0);
      EXPECT_GE(point["samples"], 256 * 144 * 16);
      EXPECT_GT(point["nanoseconds_per_sample"], 10);
    }
  EXPECT_EQ(test::run_vernier({"bench", "scale", "--axis", "light"}).exit_code, usage);
  EXPECT_EQ(test::run_vernier({"bench", "scale", "--largest", "0"}).exit_code, usage);
}

TEST(BenchCalibration, ComparesReportedErrorsWithThoseAgainstAReference) {
  test::TemporaryFolder folder;
  const std::string reference = folder.file("reference.exr"), file = folder.file("c.json");
  const auto rendered =
      test::run_vernier({"render", cornell_box, "--size", "16x16", "--spp", "1024", "--seed", "1000001",
                         "--adaptive", "off", "--aov", "error", "-o", reference});
  ASSERT_EQ(rendered.exit_code, done) << rendered.err;
  const auto result = test::run_vernier({"bench", "calibration", cornell_box, "--reference", reference,
                                         "--error", "10%", "--seeds", "4", "--json", file});
  ASSERT_EQ(result.exit_code, done) << result.err;
  const auto report = json::parse(test::read_file(file));
  EXPECT_EQ(report["runs"], 4);
  EXPECT_EQ(report["width"], 16);
  EXPECT_GE(report["samples_per_pixel"], 16);
  EXPECT_EQ(report["coverage"].size(), 4u);
  EXPECT_GT(report["coverage"][2]["measured"], 0.8);
  EXPECT_EQ(report["image"]["true_above_1.1_asked"], 0);
  EXPECT_LT(report["image"]["estimated"], 0.10);
  EXPECT_GT(report["image"]["true"], 0.03);

  const auto plain =
      test::run_vernier({"render", cornell_box, "--size", "16x16", "--spp", "4", "-o", reference});
  ASSERT_EQ(plain.exit_code, done) << plain.err;
  const auto refused = test::run_vernier({"bench", "calibration", cornell_box, "--reference", reference});
  EXPECT_EQ(refused.exit_code, input);
  ASSERT_EQ(refused.err_lines().size(), 1u) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("--aov error"));
  const auto lonely = test::run_vernier({"bench", "calibration", cornell_box, "--seeds", "2"});
  EXPECT_EQ(lonely.exit_code, usage);
  EXPECT_THAT(lonely.err, HasSubstr("--seeds"));
}

TEST(BenchBias, TellsTheBiasAndItsError) {
  test::TemporaryFolder folder;
  const std::string file = folder.file("b.json");
  const auto result = test::run_vernier(
      {"bench", "bias", "--pictures", "50", "--size", "8x8", "--spp", "32", "--json", file});
  ASSERT_EQ(result.exit_code, done) << result.err;
  EXPECT_THAT(result.out, HasSubstr("adaptive: bias"));
  const auto report = json::parse(test::read_file(file));
  for (const char* sampling : {"adaptive", "even"}) {
    const auto& found = report[sampling];
    EXPECT_EQ(found["pictures"], 50);
    EXPECT_GT(found["standard_error"], 1e-3);
    EXPECT_LT(std::abs(found["bias"].get<double>()), 6 * found["standard_error"].get<double>());
  }
}

TEST(Bench, MisuseIsOneLineAndNothingIsWritten) {
  test::TemporaryFolder folder;
  const auto expect_error = [](const std::vector<std::string>& arguments, int code, const std::string& part) {
    const auto result = test::run_vernier(arguments);
    EXPECT_EQ(result.exit_code, code);
    ASSERT_EQ(result.err_lines().size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr(part));
  };
  expect_error({"bench"}, usage, "vernier bench --help");
  expect_error({"bench", "ray", cornell_box}, usage, "rays");
  expect_error({"bench", "stability", "--cases", "edge"}, usage, "edge-1");
  expect_error({"bench", "rays"}, usage, "missing SCENE");
  expect_error({"bench", "bias", "--share", "0"}, usage, "--share");
  expect_error({"bench", "rays", cornell_box, "--accelerator", "bhv"}, usage, "bvh");
  expect_error({"bench", "rays", folder.file("none.glb"), "--json", folder.file("x.json")}, input,
               "none.glb");
  expect_error({"bench", "rays", cornell_box, "--json", folder.file("no/x.json")}, input, "no/x.json");
  EXPECT_THAT(folder.names(), testing::IsEmpty());
}

}  // namespace
}  // namespace vernier
