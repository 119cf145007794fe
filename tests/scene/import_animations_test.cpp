// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/scene/import_support.h"

// Which of a file's animations pose it, and what is said of it.

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Two triangles that stay where they are; animations are added one by one.
class Stage {
 public:
  Stage() {
    file.add_triangle();
    file.add_root({{"mesh", 0}});
  }

  /// Moves `node` along x from 0 to `end` between two times.
  void animate(int node, float end, const std::string& name, const std::vector<float>& times = {0, 1}) {
    const int input = file.add_accessor(times, "SCALAR");
    const int output = file.add_accessor(std::vector<float>{0, 0, 0, end, 0, 0}, "VEC3");
    file.add("animations",
             {{"name", name},
              {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}},
              {"samplers", {{{"input", input}, {"output", output}}}}});
  }

  SceneDescription at(double time, const std::string& animation = "") const {
    ImportOptions options;
    options.time = time;
    options.animation = animation;
    return file.import(options);
  }

  GltfFile file;
};

float x_of(const SceneDescription& scene, size_t instance) {
  return scene.instances.at(instance).to_world.origin.x;
}

TEST(ImportAnimations, ThatMoveDifferentThingsPoseTheSceneTogether) {
  Stage stage;
  stage.animate(0, 3, "door");
  stage.animate(1, 5, "window");
  const SceneDescription scene = stage.at(1);
  EXPECT_EQ(x_of(scene, 0), 3.f);
  EXPECT_EQ(x_of(scene, 1), 5.f);
  EXPECT_TRUE(has_notice(scene, "all 2 animations pose the scene, since no two move the same thing"));
  EXPECT_EQ(x_of(stage.at(1, "window"), 0), 0.f);
  EXPECT_EQ(x_of(stage.at(1, "window"), 1), 5.f);
  EXPECT_TRUE(stage.at(1, "window").notices.empty());
  EXPECT_TRUE(stage.at(1, "all").notices.empty());
}

TEST(ImportAnimations, ThatMoveTheSameThingAreTakenOneByOne) {
  Stage stage;
  stage.animate(0, 3, "walk");
  stage.animate(1, 5, "wave");
  stage.animate(0, 7, "run");
  const SceneDescription scene = stage.at(1);
  EXPECT_EQ(x_of(scene, 0), 3.f);
  EXPECT_EQ(x_of(scene, 1), 0.f);
  EXPECT_TRUE(has_notice(scene, "of 3 animations only the first, 'walk', poses the scene"));
  EXPECT_TRUE(has_notice(scene, "--animation all takes all"));

  const SceneDescription all = stage.at(1, "all");
  EXPECT_EQ(x_of(all, 0), 7.f) << "the last in the file's order";
  EXPECT_EQ(x_of(all, 1), 5.f);
  EXPECT_TRUE(has_notice(all, "1 properties are set by more than one animation; the last"));
}

TEST(ImportAnimations, OneThatIsCalledAllIsMeantByThat) {
  Stage stage;
  stage.animate(0, 3, "all");
  stage.animate(1, 5, "other");
  EXPECT_EQ(x_of(stage.at(1, "all"), 1), 0.f);
  EXPECT_EQ(x_of(stage.at(1, "all"), 0), 3.f);
}

TEST(ImportAnimations, AllOfAFileWithOneOrNone) {
  Stage stage;
  ImportOptions options;
  options.animation = "all";
  EXPECT_THAT(import_error(stage.file, options), HasSubstr("the file has no animation to pose by"));
  stage.animate(0, 3, "only");
  EXPECT_EQ(x_of(stage.at(1, "all"), 0), 3.f);
  EXPECT_TRUE(stage.at(1).notices.empty());
  EXPECT_TRUE(stage.file.import().notices.empty()) << "at rest nothing needs saying";
}

TEST(ImportAnimations, SayWhenTheTimeLiesOutside) {
  Stage stage;
  stage.animate(0, 3, "move", {0.5f, 0.7f});
  EXPECT_TRUE(has_notice(
      stage.at(0),
      "the time asked for lies outside of animation 'move' (0.5 to 0.7 s), whose nearest key holds"));
  EXPECT_TRUE(has_notice(stage.at(9), "lies outside"));
  EXPECT_EQ(x_of(stage.at(9), 0), 3.f);
  for (const double inside : {0.5, 0.6, 0.7}) EXPECT_TRUE(stage.at(inside).notices.empty()) << inside;
  for (int i = 0; i < 5; ++i) {
    stage.file.add_root({{"mesh", 0}});
    stage.animate(2 + i, 1, "more");
  }
  EXPECT_TRUE(has_notice(stage.at(2), "'more' (0 to 1 s) and 3 more, whose"));
}

TEST(ImportAnimations, StatusSaysHowTheyAreAskedFor) {
  Stage stage;
  stage.animate(0, 3, "move");
  const SceneDescription scene = stage.file.import();
  ASSERT_EQ(scene.features.size(), 1u);
  EXPECT_EQ(scene.features[0].name, "animations");
  EXPECT_THAT(scene.features[0].note, HasSubstr("at rest unless --at"));
}

}  // namespace
}  // namespace vernier::test
