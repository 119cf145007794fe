// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/process.h"
#include "tests/support/random_scenes.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_scenes.h"

// Caustics of lamps on the command line.

namespace vernier::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class CausticsFlag : public testing::Test {
 protected:
  /// A lamp in a ball of glass above a floor.
  CausticsFlag() : scene_(bulb_of("bulb.gltf", glass(0))) {}
  std::string bulb_of(const std::string& name, const MaterialDescription& material) const {
    return folder_.write(name,
                         to_gltf(SceneBuilder()
                                     .add(parallelogram({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}), diffuse(0.5f))
                                     .add(sphere({0, 1.5f, 0}, 0.4f, 16, 32), material)
                                     .add(point_lamp({0, 1.5f, 0}, 20))
                                     .description()));
  }
  ProcessResult render(const std::string& output, std::vector<std::string> more, const char* spp = "16") {
    const std::vector<std::string> all{"render",      scene_,    "-o",      folder_.file(output),
                                       "--look-from", "0,0.6,3", "--size",  "32x24",
                                       "--look-at",   "0,0,0",   "--env",   "none",
                                       "--spp",       spp,       "--fov",   "30",
                                       "--progress",  "none",    "--stats", folder_.file("stats.json")};
    more.insert(more.begin(), all.begin(), all.end());
    return run_vernier(more);
  }
  nlohmann::json stats() const { return nlohmann::json::parse(read_file(folder_.file("stats.json"))); }

  const TemporaryFolder folder_;
  std::string scene_;
};

TEST_F(CausticsFlag, BringWhatIsMissingWithout) {
  const ProcessResult off = render("off.exr", {"--caustics", "off"});
  EXPECT_EQ(off.exit_code, 0) << off.err;
  EXPECT_THAT(off.err, HasSubstr("--caustics auto brings it"));
  EXPECT_THAT(off.err, Not(HasSubstr("--caustics off")));
  EXPECT_EQ(stats()["picture"]["light_paths"], 0);
  EXPECT_GT(stats()["missing"]["bent"]["share"], 0.9);
  const ProcessResult found = render("auto.exr", {});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.err, Not(HasSubstr("missing")));
  EXPECT_THAT(found.err, HasSubstr("--caustics off leaves it out"));
  EXPECT_GE(stats()["picture"]["light_paths"], 32 * 24 * 16);
  EXPECT_LT(stats()["missing"]["bent"]["share"], 0.01);
}

// What is brought whole makes a scene exact; what is brought in part does not.
TEST_F(CausticsFlag, StrictTakesWhatIsBrought) {
  EXPECT_EQ(render("a.exr", {"--strict"}).exit_code, 0);
  scene_ = bulb_of("etched.gltf", glass(0.05f));
  const ProcessResult refused = render("b.exr", {"--strict"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("KHR_lights_punctual is approximated"));
}

// A lamp that light paths bring for being small is no caustic: what is missing is told as without it.
TEST_F(CausticsFlag, AreNotWhatSmallLampsTake) {
  scene_ = folder_.write(
      "both.gltf",
      to_gltf(SceneBuilder()
                  .add(parallelogram({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}), diffuse(0.5f))
                  .add(sphere({0, 1.5f, 0}, 0.4f, 16, 32), glass(0))
                  .add(point_lamp({0, 1.5f, 0}, 20))
                  .add(parallelogram({0.3f, 0.5f, 0}, {0.002f, 0, 0}, {0, 0.002f, 0}), emitter(100))
                  .description()));
  const ProcessResult off = render("off.exr", {"--caustics", "off"});
  EXPECT_GT(stats()["picture"]["light_paths"], 0);
  EXPECT_THAT(off.err, HasSubstr("--caustics auto brings it"));
}

TEST_F(CausticsFlag, AreTheSameFromACheckpoint) {
  ASSERT_EQ(render("whole.exr", {}).exit_code, 0);
  ASSERT_EQ(render("first.exr", {"--checkpoint", folder_.file("a.ckpt")}, "5").exit_code, 0);
  const ProcessResult resumed = render("resumed.exr", {"--resume", folder_.file("a.ckpt")});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_TRUE(read_file(folder_.file("whole.exr")) == read_file(folder_.file("resumed.exr")));
}

TEST_F(CausticsFlag, TakeThreeValues) {
  const ProcessResult wrong = render("a.exr", {"--caustics", "maybe"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--caustics"));
  EXPECT_EQ(wrong.err_lines().size(), 1u) << wrong.err;
  const ProcessResult parts = render("a.exr", {"--integrator", "light", "--aov", "light"});
  EXPECT_EQ(parts.exit_code, 2);
  EXPECT_THAT(parts.err, HasSubstr("does not keep parts of the light apart"));
}

}  // namespace
}  // namespace vernier::test
