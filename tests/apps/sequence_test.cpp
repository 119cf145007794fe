// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image_io.h"
#include "tests/apps/animated_scene.h"
#include "tests/support/process.h"

// Runs of several pictures: frames, turntables, cameras, variants, scenes.

namespace vernier::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Sequence : public testing::Test {
 protected:
  static ProcessResult render(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", "--size", "24x16", "--spp", "2", "--progress", "none"});
    return run_vernier(arguments);
  }
  /// Renders, and expects that to go well.
  static void make(const std::vector<std::string>& arguments) {
    const ProcessResult result = render(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
  std::string bytes(const std::string& name) const { return read_file(folder_.file(name)); }
  /// Names in the folder that end so.
  std::vector<std::string> names(const std::string& ending) const {
    std::vector<std::string> all = folder_.names(), chosen;
    for (const std::string& name : all)
      if (name.ends_with(ending)) chosen.push_back(name);
    return chosen;
  }

  const TemporaryFolder folder_;
  const std::string scene_ = animated_scene().save(folder_);
};

TEST_F(Sequence, FramesHaveTheBytesOfSingleRenders) {
  make({scene_, "--frames", "1-3x2,4", "--fps", "4", "-o", folder_.file("f.####.exr"), "-o",
        folder_.file("f.{frame}.png"), "--aov", "normal"});
  EXPECT_THAT(names(".exr"), ElementsAre("f.0001.exr", "f.0003.exr", "f.0004.exr"));
  for (const auto& [frame, time] :
       {std::pair("0001", "0.250"), std::pair("0003", "0.75"), std::pair("0004", "1")}) {
    make({scene_, "--at", time, "-o", folder_.file("single.exr"), "-o", folder_.file("single.png"), "--aov",
          "normal", "-t", "1"});
    EXPECT_EQ(bytes(std::string("f.") + frame + ".exr"), bytes("single.exr")) << frame;
    EXPECT_EQ(bytes(std::string("f.") + frame + ".png"), bytes("single.png")) << frame;
  }
  EXPECT_NE(bytes("f.0001.png"), bytes("f.0003.png"));
}

TEST_F(Sequence, TurntablePicturesHaveTheBytesOfSingleRenders) {
  make({two_spheres, "--turntable", "3", "--env", "studio", "-o", folder_.file("t.##.exr")});
  EXPECT_THAT(names(".exr"), ElementsAre("t.01.exr", "t.02.exr", "t.03.exr"));
  for (const char* side : {"1", "2", "3"}) {
    make({two_spheres, "--turntable", "3", "--frames", side, "--env", "studio", "-o",
          folder_.file("single.exr")});
    EXPECT_EQ(bytes(std::string("t.0") + side + ".exr"), bytes("single.exr")) << side;
  }
  EXPECT_NE(bytes("t.01.exr"), bytes("t.02.exr"));
}

TEST_F(Sequence, TurntableDecidesAboutSurroundingsAsSingleRendersDo) {
  const std::string dark = GltfFile().save(folder_, "dark.gltf");
  make({dark, "--turntable", "2", "-o", folder_.file("t.##.exr")});
  make({dark, "--turntable", "2", "--frames", "2", "-o", folder_.file("single.exr")});
  EXPECT_EQ(bytes("t.02.exr"), bytes("single.exr"));
}

// The triangle moves a metre a second, at 4 frames a second and 4 pixels a metre.
TEST_F(Sequence, MotionIsInPixelsFromFrameToFrame) {
  const std::vector<std::string> layer{"--aov", "motion,id", "--look-from", "0,0,5", "--look-at",
                                       "0,0,0", "--ortho",   "4",           "--fps", "4"};
  const auto with_layer = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), layer.begin(), layer.end());
    return arguments;
  };
  make(with_layer({scene_, "--frames", "0-2", "-o", folder_.file("f.#####.exr")}));
  const LayeredImage first = read_layers(folder_.file("f.00000.exr")),
                     second = read_layers(folder_.file("f.00001.exr"));
  const auto expect = [](const LayeredImage& picture, const char* channel, float moving) {
    const Image id = *picture.single("id"), motion = *picture.single(channel);
    size_t seen = 0;
    for (size_t i = 0; i < id.values.size(); ++i) {
      EXPECT_NEAR(motion.values[i], id.values[i] == 1 ? moving : 0, 1e-4) << channel;
      seen += id.values[i] == 1;
    }
    EXPECT_GT(seen, 0u);
  };
  for (const auto& [channel, moving] : {std::pair("Vector.X", -1.f),
                                        {"Vector.Y", 0.f},
                                        {"Vector.Z", -1.f},
                                        {"Vector.W", 0.f},
                                        {"forward.u", 1.f},
                                        {"forward.v", 0.f},
                                        {"backward.u", -1.f}})
    expect(second, channel, moving);
  expect(first, "backward.u", 0);  // before the animation it stands still
  expect(first, "forward.u", 1);
  make(with_layer({scene_, "--at", "0.25", "-o", folder_.file("single.exr")}));
  EXPECT_EQ(bytes("f.00001.exr"), bytes("single.exr"));
}

TEST_F(Sequence, MotionOfATurntableIsThatOfItsCamera) {
  make({scene_, "--turntable", "4", "--ortho", "4", "--aov", "motion", "-o", folder_.file("t.##.exr")});
  const LayeredImage picture = read_layers(folder_.file("t.01.exr"));
  const Image motion = *picture.single("forward.u");
  EXPECT_GT(std::abs(*std::max_element(motion.values.begin(), motion.values.end())), 0.1);
  make({scene_, "--turntable", "4", "--frames", "1", "--ortho", "4", "--aov", "motion", "-o",
        folder_.file("single.exr")});
  EXPECT_EQ(bytes("t.01.exr"), bytes("single.exr"));
}

TEST_F(Sequence, TimeBeyondTheAnimationIsSaidOnce) {
  const ProcessResult result =
      render({scene_, "--frames", "1-4", "--fps", "2", "-o", folder_.file("f.####.png")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err,
              HasSubstr("note: frame 3: /animations: the time asked for lies outside of animation "
                        "'slide' (0 to 1 s), whose nearest key holds"));
  EXPECT_THAT(result.err, Not(HasSubstr("frame 4:")));
  EXPECT_EQ(read_image(folder_.file("f.0003.png")).values, read_image(folder_.file("f.0004.png")).values);
}

TEST_F(Sequence, AllCamerasMakeAPictureEach) {
  GltfFile file = animated_scene();
  for (const char* name : {"front", "side/top", "front"}) {
    const int camera =
        file.add("cameras", {{"type", "perspective"},
                             {"name", name},
                             {"perspective", {{"yfov", 0.6}, {"aspectRatio", 1.5}, {"znear", 0.1}}}});
    file.add_root({{"camera", camera}, {"translation", {0, 0, 4 + camera}}});
  }
  const std::string scene = file.save(folder_, "cameras.gltf");
  make({scene, "--camera", "all", "-o", folder_.file("c.{camera}.exr")});
  EXPECT_THAT(names(".exr"), ElementsAre("c.0.exr", "c.2.exr", "c.side_top.exr"));
  make({scene, "--camera", "2", "-o", folder_.file("single.exr")});
  EXPECT_EQ(bytes("c.2.exr"), bytes("single.exr"));
}

TEST_F(Sequence, AllCamerasOfASceneWithoutAnyAreOneThatIsFitted) {
  make({scene_, "--camera", "all", "-o", folder_.file("c.{camera}.exr")});
  EXPECT_THAT(names(".exr"), ElementsAre("c.fitted.exr"));
  make({scene_, "-o", folder_.file("single.exr")});
  EXPECT_EQ(bytes("c.fitted.exr"), bytes("single.exr"));
}

TEST_F(Sequence, AllVariantsMakeAPictureEach) {
  GltfFile file = animated_scene();
  const int blue = file.add("materials", {{"emissiveFactor", {0, 0, 1}}, {"doubleSided", true}});
  file.json["extensionsUsed"] = {"KHR_materials_variants"};
  file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "warm"}}, {{"name", "cold"}}};
  file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
      {{"material", blue}, {"variants", {1}}}};
  const std::string scene = file.save(folder_, "variants.gltf");
  make({scene, "--variant", "all", "-o", folder_.file("{name}-{variant}.exr"), "--stats",
        folder_.file("{variant}.json")});
  EXPECT_THAT(names(".exr"), ElementsAre("variants-cold.exr", "variants-warm.exr"));
  EXPECT_THAT(names(".json"), ElementsAre("cold.json", "warm.json"));
  make({scene, "--variant", "cold", "-o", folder_.file("single.exr")});
  EXPECT_EQ(bytes("variants-cold.exr"), bytes("single.exr"));
}

TEST_F(Sequence, ScenesOfARunGoToFilesOfTheirOwn) {
  make({two_spheres, cornell_box, "-o", folder_.file("{name}/picture.png")});
  make({cornell_box, "-o", folder_.file("single.png")});
  EXPECT_EQ(bytes("cornell_box/picture.png"), bytes("single.png"));
  EXPECT_GT(bytes("two_spheres/picture.png").size(), 100u);
}

TEST_F(Sequence, AFailureEndsTheRunUnlessItKeepsGoing) {
  const std::string broken = folder_.write("broken.gltf", "{");
  const std::vector<std::string> scenes{broken, cornell_box, "-o", folder_.file("{name}.png")};
  const ProcessResult ended = render(scenes);
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_THAT(names(".png"), ElementsAre());
  std::vector<std::string> going = scenes;
  going.push_back("--keep-going");
  const ProcessResult result = render(going);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("error: " + broken));
  EXPECT_THAT(result.err, HasSubstr("error: 1 of 2 pictures failed"));
  EXPECT_THAT(names(".png"), ElementsAre("cornell_box.png"));
}

TEST_F(Sequence, SkipsWhatIsThereAndFinished) {
  const std::vector<std::string> run{scene_,           "--frames", "1-3", "-o", folder_.file("f.##.exr"),
                                     "--skip-existing"};
  make(run);
  const std::string second = bytes("f.02.exr");
  std::filesystem::remove(folder_.file("f.01.exr"));
  LayeredImage partial = read_layers(folder_.file("f.03.exr"));
  partial.metadata["vernier:stoppedBy"] = "unfinished";
  write_exr(folder_.file("f.03.exr"), partial.image, partial.channel_names, partial.metadata);
  const ProcessResult result = render(run);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("wrote " + folder_.file("f.01.exr")));
  EXPECT_THAT(result.out, HasSubstr("skipped " + folder_.file("f.02.exr")));
  EXPECT_THAT(result.out, HasSubstr("wrote " + folder_.file("f.03.exr")));
  EXPECT_EQ(bytes("f.02.exr"), second);
  EXPECT_EQ(read_layers(folder_.file("f.03.exr")).metadata.at("vernier:stoppedBy"), "samples");
}

TEST_F(Sequence, SkippingKnowsUnfinishedDisplayFiles) {
  for (const char* name : {"a.png", "a.jpg"}) {
    const std::vector<std::string> run{cornell_box, "-o", folder_.file(name), "--skip-existing"};
    make(run);
    EXPECT_THAT(render(run).out, HasSubstr("skipped"));
    write_image8(folder_.file(name), Image8(24, 16, 3), {{"vernier:stoppedBy", "interrupted"}});
    EXPECT_THAT(render(run).out, HasSubstr("wrote"));
  }
}

TEST_F(Sequence, CheckpointsAreOfOnePictureEach) {
  const std::vector<std::string> run{scene_,
                                     "--frames",
                                     "1-2",
                                     "-o",
                                     folder_.file("f.##.exr"),
                                     "--checkpoint",
                                     folder_.file("f.##.ckpt"),
                                     "--resume",
                                     folder_.file("f.##.ckpt"),
                                     "--report",
                                     folder_.file("f.##.html")};
  make(run);
  EXPECT_THAT(names(".ckpt"), ElementsAre("f.01.ckpt", "f.02.ckpt"));
  EXPECT_THAT(names(".html"), ElementsAre("f.01.html", "f.02.html"));
  const std::string second = bytes("f.02.exr");
  const ProcessResult again = render(run);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("going on from " + folder_.file("f.02.ckpt")));
  EXPECT_EQ(bytes("f.02.exr"), second);
}

struct Misuse {
  std::vector<std::string> arguments;  ///< after SCENE; FOLDER/ in front of what begins with a slash
  std::string text;
};

class SequenceMisuse : public Sequence, public testing::WithParamInterface<Misuse> {};

TEST_P(SequenceMisuse, IsOneClearLineAndWritesNothing) {
  const std::vector<std::string> before = folder_.names();
  std::vector<std::string> arguments{scene_};
  for (const std::string& argument : GetParam().arguments)
    arguments.push_back(argument.starts_with('/') ? folder_.path().string() + argument : argument);
  const ProcessResult result = render(arguments);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
  EXPECT_THAT(result.err, HasSubstr(GetParam().text));
  EXPECT_EQ(folder_.names(), before);
}

INSTANTIATE_TEST_SUITE_P(
    Sequence, SequenceMisuse,
    testing::Values(
        Misuse{{"-o", "/f.####.png"}, "--frames or --turntable gives some"},
        Misuse{{"-o", "/f.{frame}.png"}, "--frames or --turntable gives some"},
        Misuse{{"-o", "/f.{frmae}.png"}, "unknown placeholder '{frmae}'; did you mean '{frame}'?"},
        Misuse{{"-o", "/f.%04d.png", "--frames", "1-2"}, "'%04d' is no placeholder; #### or {frame}"},
        Misuse{{"-o", "/f.png", "--frames", "1-2"},
               "f.png: 2 frames would be written over each other; put {frame} or ####"},
        Misuse{{"-o", "/f.#.png", "--turntable", "2"}, "put {frame} or ####"},
        Misuse{{"-o", "/f.##.png", "--frames", "1-2", "--stats", "/f.json"}, "f.json: 2 frames"},
        Misuse{{"-o", "/f.##.png", "--frames", "1-2", "--report", "/f.html"}, "f.html: 2 frames"},
        Misuse{{"-o", "/f.##.png", "--frames", "1-2", "--checkpoint", "/f.ckpt"}, "f.ckpt: 2 frames"},
        Misuse{{cornell_box, "-o", "/f.png"}, "2 scenes would be written over each other; put {name}"},
        Misuse{{"/scene.gltf", "-o", "/{name}.png"}, "would be rendered over itself"},
        Misuse{{"-o", "/f.png", "--camera", "all"}, "put {camera} into the name"},
        Misuse{{"-o", "/f.png", "--variant", "all"}, "put {variant} into the name"},
        Misuse{{"-o", "/f.{variant}.png"}, "--variant NAME or --variant all does"},
        Misuse{{"-o", "-", "--frames", "1-2"}, "-o - takes one picture; 2 frames need files of their own"},
        Misuse{{"-o", "/f.##.png", "--frames", "1..5"}, "did you mean 1-5?"},
        Misuse{{"-o", "/f.##.png", "--frames", "5-1"}, "did you mean 1-5?"},
        Misuse{{"-o", "/f.##.png", "--frames", "1-5x0"}, "did you mean 1-5x2?"},
        Misuse{{"-o", "/f.##.png", "--frames", "1,,2"}, "'' is no frame"},
        Misuse{{"-o", "/f.##.png", "--frames", "-3"}, "'-3' is no frame"},
        Misuse{{"-o", "/f.##.png", "--frames", "1-2", "--at", "1"},
               "--frames and --at contradict each other"},
        Misuse{{"-o", "/f.exr", "--aov", "motion"}, "add --frames, --at or --turntable"},
        Misuse{{"-o", "/f.png", "--fps", "25"}, "--fps needs --frames"},
        Misuse{{"-o", "/f.##.png", "--turntable", "4", "--fps", "25"}, "--fps means nothing to --turntable"},
        Misuse{{"-o", "/f.##.png", "--turntable", "4", "--frames", "0-4"}, "has pictures 1 to 4, not 0"},
        Misuse{{"-o", "/f.##.png", "--turntable", "4", "--panorama"}, "sees all around already"},
        Misuse{{"-o", "/f.png", "--turntable", "0"}, "--turntable: '0' is not a whole number from 1"},
        Misuse{{"-o", "/f.png", "--format", "png"}, "--format needs -o -"},
        Misuse{{"-o", "-", "--format", "pgn"}, "did you mean 'png'?"},
        Misuse{{"-o", "-", "-o", "-"}, "standard output takes one picture"},
        Misuse{{"-o", "/f.png", "--write-every", "nver"}, "did you mean 'never'?"}));

}  // namespace
}  // namespace vernier::test
