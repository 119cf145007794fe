// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/documented_fields.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/// Runs `vernier render ... --progress json` and reads its standard error, which must hold nothing else.
class ProgressEvents : public testing::Test {
 protected:
  std::vector<json> render(std::vector<std::string> arguments, int exit_code) const {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"--progress", "json"});
    const ProcessResult result = run_vernier(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    std::vector<json> events;
    for (const std::string& line : result.err_lines()) events.push_back(json::parse(line));
    for (const json& event : events)
      EXPECT_THAT(undocumented_fields(event, "progress.md"), testing::IsEmpty()) << event;
    EXPECT_GE(events.size(), 2u);
    EXPECT_EQ(events.front()["event"], "started");
    EXPECT_EQ(events.back()["event"], "finished");
    EXPECT_EQ(events.back()["exit_code"], exit_code);
    return events;
  }

  static std::vector<std::string> names(const std::vector<json>& events) {
    std::vector<std::string> names;
    for (const json& event : events)
      if (names.empty() || event["event"] != "progress" || names.back() != "progress")
        names.push_back(event["event"]);
    return names;
  }
  static std::vector<json> called(const std::vector<json>& events, const std::string& name) {
    std::vector<json> found;
    for (const json& event : events)
      if (event["event"] == name) found.push_back(event);
    return found;
  }

  const TemporaryFolder folder_;
};

TEST_F(ProgressEvents, TellTheWholeOfAPicture) {
  const std::string exr = folder_.file("a.exr"), png = folder_.file("a.png");
  const auto events = render({cornell_box, "-o", exr, "-o", png, "--size", "128x128", "--time", "1s"}, 0);
  EXPECT_THAT(names(events), ElementsAre("started", "rendering", "progress", "wrote", "wrote", "finished"));
  EXPECT_THAT(events[0]["command"], HasSubstr("--time 1s"));
  EXPECT_EQ(events[1]["outputs"], (json{exr, png}));
  EXPECT_EQ(events[1]["asked"],
            (json{{"samples_per_pixel", nullptr}, {"seconds", 1.0}, {"rel_rmse", nullptr}}));
  double last = 0;
  for (const json& progress : called(events, "progress")) {
    EXPECT_GE(progress["fraction"].get<double>(), last);
    last = progress["fraction"];
    EXPECT_LE(last, 1.0);
  }
  const auto wrote = called(events, "wrote");
  EXPECT_EQ(wrote[0]["file"], exr);
  EXPECT_EQ(wrote[0]["channels"], (json{"R", "G", "B"}));
  EXPECT_EQ(wrote[1]["bytes"], read_file(png).size());
  EXPECT_LE(wrote[1]["low"], wrote[1]["rel_rmse"]);
}

TEST_F(ProgressEvents, TellFailuresAndNotesOfARun) {
  const std::string bad = folder_.write("bad.gltf", "{"),
                    empty = folder_.write("empty.gltf", R"({"asset": {"version": "2.0"}})");
  const auto events = render(
      {bad, empty, "-o", folder_.file("{name}.png"), "--size", "8x8", "--spp", "1", "--keep-going"}, 3);
  const auto failed = called(events, "failed");
  ASSERT_EQ(failed.size(), 2u);  // the scene, and how many have failed
  EXPECT_THAT(failed[0]["text"], HasSubstr("bad.gltf"));
  EXPECT_GE(called(events, "warning").size() + called(events, "note").size(), 1u);
  ASSERT_EQ(called(events, "rendering").size(), 1u);
  EXPECT_EQ(called(events, "rendering")[0]["picture"], 2);
  EXPECT_EQ(called(events, "wrote").size(), 1u);

  const auto again = render({empty, "-o", folder_.file("{name}.png"), "--skip-existing"}, 0);
  EXPECT_THAT(names(again), ElementsAre("started", "skipped", "finished"));
}

TEST_F(ProgressEvents, TellMisuseBeforeTheFlagsAreRead) {
  EXPECT_THAT(names(render({cornell_box, "--siez", "8x8"}, 2)), ElementsAre("started", "failed", "finished"));
  EXPECT_THAT(names(render({cornell_box}, 2)), ElementsAre("started", "failed", "finished"));
}

}  // namespace
}  // namespace vernier::test
