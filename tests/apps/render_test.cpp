// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/image/image_io.h"
#include "integrators/integrator.h"
#include "scene/accel/accelerator.h"
#include "tests/support/process.h"

namespace vernier {
namespace {

using test::cornell_box;
using test::ProcessResult;
using test::run_vernier;
using test::two_spheres;
using testing::HasSubstr;

ProcessResult render(const std::string& scene, const std::string& output,
                     std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"render", scene, "-o", output, "--progress", "none"});
  return run_vernier(more);
}

/// Renders and reads the picture back.
Image rendered(const std::string& scene, const std::vector<std::string>& more) {
  const test::TemporaryFolder folder;
  const ProcessResult result = render(scene, folder.file("out.exr"), more);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return read_image(folder.file("out.exr"));
}

double mean(const Image& image) {
  double sum = 0;
  for (const float value : image.values) sum += value;
  return sum / double(image.values.size());
}

TEST(Render, EveryIntegratorAndAcceleratorMakesAPicture) {
  for (const IntegratorEntry& integrator : integrators()) {
    const Image image = rendered(
        two_spheres, {"--integrator", std::string(integrator.name), "--size", "16x12", "--spp", "2"});
    EXPECT_EQ(image.width, 16);
    EXPECT_EQ(image.height, 12);
    EXPECT_GT(mean(image), 0.01) << integrator.name;
  }
  const Image reference = rendered(cornell_box, {"--size", "16x16", "--spp", "4"});
  for (const AcceleratorEntry& accelerator : accelerators()) {
    const Image image = rendered(
        cornell_box, {"--accelerator", std::string(accelerator.name), "--size", "16x16", "--spp", "4"});
    EXPECT_NEAR(mean(image), mean(reference), 0.05 * mean(reference)) << accelerator.name;
  }
}

TEST(Render, EveryShowMakesAPicture) {
  for (const auto& show : raycast_outputs()) {
    const Image image = rendered(two_spheres, {"--integrator", "raycast", "--show", std::string(show),
                                               "--size", "16x12", "--spp", "1"});
    EXPECT_GT(mean(image), 0.0) << show;
  }
}

TEST(Render, SameValuesForAnyNumberOfThreads) {
  for (const IntegratorEntry& integrator : integrators()) {
    const auto with_threads = [&](const char* threads) {
      return rendered(two_spheres, {"--integrator", std::string(integrator.name), "--size", "70x50", "--spp",
                                    "3", "--threads", threads});
    };
    const Image one = with_threads("1");
    EXPECT_EQ(one.values, with_threads("2").values) << integrator.name;
    EXPECT_EQ(one.values, with_threads("7").values) << integrator.name;
  }
}

TEST(Render, SameCommandSameBytes) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> files{folder.file("a.exr"), folder.file("a.png"), folder.file("a.jpg")};
  std::vector<std::string> bytes;
  for (const char* threads : {"2", "2", "1"}) {
    ASSERT_EQ(render(cornell_box, files[0],
                     {"-o", files[1], "-o", files[2], "--size", "24x24", "--spp", "20", "--aov", "all",
                      "--threads", threads})
                  .exit_code,
              0);
    for (const auto& file : files) bytes.push_back(test::read_file(file));
    EXPECT_FALSE(read_layers(files[0]).metadata.contains("DateTime"));  // the same within a second
  }
  for (size_t i = 0; i < files.size(); ++i) {
    EXPECT_EQ(bytes[i], bytes[i + files.size()]) << files[i];
    EXPECT_EQ(bytes[i], bytes[i + 2 * files.size()]) << files[i] << " on another number of threads";
  }
}

TEST(Render, SeedChangesThePicture) {
  const auto with_seed = [](const char* seed) {
    return rendered(cornell_box, {"--size", "16x16", "--spp", "1", "--seed", seed});
  };
  EXPECT_EQ(with_seed("5").values, with_seed("5").values);
  EXPECT_NE(with_seed("5").values, with_seed("6").values);
}

TEST(Render, CropIsThatPartOfTheWhole) {
  const Image whole = rendered(cornell_box, {"--size", "40x30", "--spp", "2", "--adaptive", "off"});
  const Image part =
      rendered(cornell_box, {"--size", "40x30", "--spp", "2", "--adaptive", "off", "--crop", "11x7+20+3"});
  ASSERT_EQ(part.width, 40) << "read as the picture that it is a part of";
  ASSERT_EQ(part.height, 30);
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x) {
      const bool is_in = x >= 20 && x < 31 && y >= 3 && y < 10;
      EXPECT_EQ(rgb_at(part, x, y), is_in ? rgb_at(whole, x, y) : Rgb(0, 0, 0));
    }
}

TEST(Render, SizeFollowsTheCamera) {
  const Image square = rendered(cornell_box, {"--integrator", "raycast", "--spp", "1"});
  EXPECT_EQ(square.width, 1024);
  EXPECT_EQ(square.height, 1024);
  const Image wide = rendered(two_spheres, {"--integrator", "raycast", "--spp", "1"});
  EXPECT_EQ(wide.width, 1280);
  EXPECT_EQ(wide.height, 960);
}

TEST(Render, HeaderTellsHowThePictureCameAbout) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("out.exr");
  ASSERT_EQ(render(cornell_box, path, {"--size", "8x8", "--spp", "3", "--seed", "9"}).exit_code, 0);
  const LayeredImage file = read_layers(path);
  Metadata header = file.metadata;
  EXPECT_EQ(file.channel_names, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_THAT(header["Software"], HasSubstr("vernier "));
  EXPECT_THAT(header["vernier:command"], HasSubstr("--seed 9"));
  EXPECT_EQ(header["vernier:samples"], "192");
  EXPECT_EQ(header["vernier:samplesPerPixel"], "3");
  EXPECT_EQ(header["vernier:seed"], "9");
  EXPECT_EQ(header["vernier:integrator"], "path");
  EXPECT_EQ(header["vernier:camera"], "front");
  EXPECT_EQ(header["vernier:filter"], "box:1");
  EXPECT_EQ(header["vernier:sceneHash"].size(), 32u);
}

TEST(Render, StatisticsAddUp) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(render(cornell_box, folder.file("a.png"),
                   {"-o", folder.file("a.exr"), "--size", "16x8", "--spp", "5", "--threads", "2", "--stats",
                    folder.file("a.json")})
                .exit_code,
            0);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.exr", "a.json", "a.png"}));
  const auto stats = nlohmann::json::parse(test::read_file(folder.file("a.json")));
  EXPECT_EQ(stats["picture"]["samples"], 16 * 8 * 5);
  EXPECT_EQ(stats["picture"]["samples_per_pixel"], 5);
  EXPECT_EQ(stats["picture"]["stopped_by"], "samples");
  EXPECT_EQ(stats["picture"]["files"].size(), 2u);
  EXPECT_EQ(stats["rays"]["camera"], 16 * 8 * 5);
  EXPECT_EQ(stats["rays"]["total"].get<int>(), stats["rays"]["camera"].get<int>() +
                                                   stats["rays"]["bounce"].get<int>() +
                                                   stats["rays"]["shadow"].get<int>());
  EXPECT_GT(stats["rays"]["shadow"].get<int>(), 0);
  EXPECT_EQ(stats["scene"]["counts"]["triangles"], 32);
  EXPECT_EQ(stats["scene"]["counts"]["emissive_triangles"], 2);
  EXPECT_EQ(stats["machine"]["threads"], 2);
  EXPECT_GT(stats["peak_memory_bytes"].get<double>(), 1e6);
  EXPECT_EQ(stats["bad_samples"]["count"], 0);
}

TEST(Render, TimeLimitIsNotAnError) {
  const test::TemporaryFolder folder;
  const ProcessResult result =
      render(cornell_box, folder.file("a.exr"),
             {"--size", "32x32", "--time", "0.2s", "--stats", folder.file("a.json")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto stats = nlohmann::json::parse(test::read_file(folder.file("a.json")));
  EXPECT_EQ(stats["picture"]["stopped_by"], "time");
  EXPECT_GE(stats["picture"]["samples_per_pixel"].get<double>(), 1.0);
}

TEST(Render, SceneWithoutCameraOrLightSaysSo) {
  const test::TemporaryFolder folder;
  const std::string scene = folder.write("empty.gltf", R"({"asset": {"version": "2.0"}})");
  const ProcessResult result = render(scene, folder.file("a.png"), {"--size", "8x8", "--spp", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err,
              testing::AllOf(HasSubstr("nothing to see"), HasSubstr("no light"), HasSubstr("studio")));
  const ProcessResult quiet = render(scene, folder.file("b.png"), {"--size", "8x8", "--spp", "1", "-q"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.err, "");
  EXPECT_EQ(quiet.out, "");
}

TEST(Render, EnvironmentLightsTheScene) {
  const test::TemporaryFolder folder;
  Image picture(8, 4, 3);
  for (float& value : picture.values) value = 2;
  write_exr(folder.file("sky.exr"), picture, {"R", "G", "B"}, {});
  const std::string scene = folder.write("empty.gltf", R"({"asset": {"version": "2.0"}})");
  ASSERT_EQ(render(scene, folder.file("a.exr"),
                   {"--env", folder.file("sky.exr"), "--env-scale", "1.5", "--size", "4x4", "--spp", "1"})
                .exit_code,
            0);
  for (const float value : read_image(folder.file("a.exr")).values) EXPECT_FLOAT_EQ(value, 3);
}

TEST(Render, ExposureIsForDisplayFilesOnly) {
  const test::TemporaryFolder folder;
  const auto brightness = [&](const char* exposure, const char* name) {
    EXPECT_EQ(render(cornell_box, folder.file(name),
                     {"--size", "16x16", "--spp", "4", "--exposure", exposure, "--view", "raw"})
                  .exit_code,
              0);
    return mean(read_image(folder.file(name)));
  };
  EXPECT_GT(brightness("2", "bright.png"), 1.5 * brightness("0", "plain.png"));
  EXPECT_EQ(brightness("2", "bright.exr"), brightness("0", "plain.exr"));
}

TEST(Render, ScenesCanBePosedAndVariedOnlyAsTheyAllow) {
  const test::TemporaryFolder folder;
  const ProcessResult result = render(cornell_box, folder.file("a.exr"), {"--variant", "blue"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("blue"));
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace vernier
