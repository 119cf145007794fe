// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/image/image_io.h"
#include "tests/support/process.h"

// What the camera sees behind a scene, from the command line to the files.

namespace vernier::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class BackgroundFlags : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.file(name); }
  ProcessResult render(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"render", scene_,       "--size", "32x24",      "--spp",
                                       "8",      "--adaptive", "off",    "--progress", "none"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_vernier(arguments);
  }
  /// Of a command that has to succeed.
  static void must(const ProcessResult& result) { ASSERT_EQ(result.exit_code, 0) << result.err; }

  const TemporaryFolder folder_;
  /// A triangle that glows white and reflects nothing.
  const std::string scene_ = folder_.write("triangle.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "extensionsUsed": ["KHR_materials_specular"],
    "materials": [{"emissiveFactor": [1, 1, 1], "doubleSided": true,
                   "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
                   "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                   "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36,
                 "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
};

TEST_F(BackgroundFlags, AlphaIsAssociatedInOpenExrAndStraightInPng) {
  must(render({"--transparent", "--env", "sky", "--view", "raw", "-o", file("a.exr"), "-o", file("a.png")}));
  const LayeredImage exr = read_layers(file("a.exr")), png = read_layers(file("a.png"));
  ASSERT_EQ(exr.channel_names, (std::vector<std::string>{"R", "G", "B", "A"}));
  ASSERT_EQ(png.channel_names, exr.channel_names);
  int edges = 0;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x) {
      const float* linear = exr.image.pixel(x, y);
      const float* shown = png.image.pixel(x, y);
      EXPECT_NEAR(shown[3], linear[3], 0.003);
      EXPECT_NEAR(linear[0], linear[3], 1e-6) << "a radiance of 1 times alpha";
      if (linear[3] > 0) {
        EXPECT_EQ(shown[0], 1);
      }
      edges += linear[3] > 0 && linear[3] < 1;
    }
  EXPECT_GT(edges, 20);
  EXPECT_EQ(exr.image.pixel(0, 0)[3], 0) << "the sky is not part of it";
}

TEST_F(BackgroundFlags, ColorsAreSrgbOrLinear) {
  for (const auto& [text, red, green, blue] :
       {std::tuple("#ff8000", 1.f, 0.2158605f, 0.f), std::tuple("ff8000", 1.f, 0.2158605f, 0.f),
        std::tuple("0.25,2,0", 0.25f, 2.f, 0.f)}) {
    must(render({"--background", text, "--env", "sky", "-o", file("a.exr"), "-o", file("a.jpg"), "--stats",
                 file("a.json")}));
    const LayeredImage picture = read_layers(file("a.exr"));
    EXPECT_EQ(picture.channel_names.size(), 3u);
    EXPECT_NEAR(picture.image.pixel(0, 0)[0], red, 1e-6);
    EXPECT_NEAR(picture.image.pixel(0, 0)[1], green, 1e-6);
    EXPECT_NEAR(picture.image.pixel(0, 0)[2], blue, 1e-6);
    EXPECT_THAT(nlohmann::json::parse(read_file(file("a.json")))["picture"]["background"].get<std::string>(),
                HasSubstr(","));
  }
}

TEST_F(BackgroundFlags, WhatCannotBeIsRefusedInALine) {
  folder_.write("notes.txt", "no picture");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--transparent", "-o", file("a.jpg")}, "a.jpg: this kind of file has no alpha"},
      {{"--transparent", "--background", "0,0,0", "-o", file("a.png")}, "drop it or --background"},
      {{"--background", "blu", "-o", file("a.png")}, "'blu' is no file and no colour"},
      {{"--background", "1,2", "-o", file("a.png")}, "'1,2' is no file and no colour"},
      {{"--background", "0,0,-1", "-o", file("a.png")}, "'0,0,-1' is no file and no colour"},
      {{"--background", "#12345", "-o", file("a.png")}, "'#12345' is no file and no colour"},
      {{"--background", file("none.png"), "-o", file("a.png")}, "none.png"},
      {{"--background", file("notes.txt"), "-o", file("a.png")}, "notes.txt"},
      {{"--background", file("a.png"), "-o", file("a.png")}, "a.png"},
      {{"--ground", "grass", "-o", file("a.png")}, "none,matte,shadow"},
      {{"--ground", "shadow", "-o", file("a.png")}, "add --transparent or --background"},
      {{"--ground", "shadow", "--transparent", "--integrator", "whitted", "-o", file("a.png")},
       "needs --integrator path"}};
  for (const auto& [flags, complaint] : cases) {
    const ProcessResult result = render(flags);
    EXPECT_NE(result.exit_code, 0) << complaint;
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr(complaint));
    EXPECT_FALSE(std::filesystem::exists(file("a.png")));
  }
}

TEST_F(BackgroundFlags, OtherCommandsKeepAlpha) {
  const std::string clear = file("clear.exr"), colored = file("colored.exr");
  must(render({"--transparent", "-o", clear, "-o", file("clear.png"), "--aov", "error,half", "--seed", "1",
               "--checkpoint", file("1.ckpt")}));
  must(render({"--transparent", "-o", file("2.exr"), "--seed", "2", "--checkpoint", file("2.ckpt")}));
  must(render({"--background", "0.5,1,0", "-o", colored, "--seed", "1"}));

  must(run_vernier({"develop", clear, "-o", file("developed.png")}));
  EXPECT_EQ(read_layers(file("developed.png")).image.values, read_layers(file("clear.png")).image.values);
  must(run_vernier({"develop", clear, "-o", file("over.exr"), "--background", "0.5,1,0"}));
  const Image over = read_image(file("over.exr")), there = read_image(colored);
  for (size_t i = 0; i < over.values.size(); ++i) ASSERT_NEAR(over.values[i], there.values[i], 1e-5);

  must(run_vernier({"denoise", clear, "-o", file("denoised.exr")}));
  EXPECT_EQ(read_layers(file("denoised.exr")).single("A")->values, read_layers(clear).single("A")->values);
  must(run_vernier({"merge", file("1.ckpt"), file("2.ckpt"), "-o", file("merged.exr")}));
  EXPECT_TRUE(read_layers(file("merged.exr")).single("A"));

  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"develop", clear, "-o", file("b.jpg")},
           {"denoise", clear, "-o", file("b.jpg")},
           {"merge", file("1.ckpt"), file("2.ckpt"), "-o", file("b.jpg")}}) {
    const ProcessResult result = run_vernier(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments.front();
    EXPECT_THAT(result.err, AllOf(HasSubstr("b.jpg"), HasSubstr("no alpha")));
  }
  EXPECT_THAT(run_vernier({"develop", colored, "-o", file("b.png"), "--background", "1,1,1"}).err,
              HasSubstr("has no alpha"));
}

// Other programs write alpha that is 1 everywhere.
TEST_F(BackgroundFlags, AlphaThatHidesAllIsNoObstacle) {
  Image picture(6, 4, 4);
  std::fill(picture.values.begin(), picture.values.end(), 1.f);
  write_exr(file("opaque.exr"), picture, {"R", "G", "B", "A"}, {});
  for (const char* command : {"develop", "denoise"}) {
    must(run_vernier({command, file("opaque.exr"), "-o", file("a.jpg")}));
    EXPECT_EQ(read_layers(file("a.jpg")).channel_names.size(), 3u) << command;
  }
  picture.values.back() = 0.5f;
  write_exr(file("clear.exr"), picture, {"R", "G", "B", "A"}, {});
  EXPECT_EQ(run_vernier({"develop", file("clear.exr"), "-o", file("b.jpg")}).exit_code, 2);
}

TEST_F(BackgroundFlags, ComparisonsCountThePixelsThatShowSomething) {
  must(render({"--transparent", "-o", file("a.exr"), "--seed", "1"}));
  must(render({"--transparent", "-o", file("b.exr"), "--seed", "2"}));
  must(render({"--background", "0,0,0", "-o", file("c.exr"), "--seed", "2"}));
  const auto compared = [&](const char* x, const char* r) {
    const ProcessResult result = run_vernier({"compare", file(x), file(r), "--json", "--no-flip"});
    return nlohmann::json::parse(result.out);
  };
  // The opaque ones are the same pictures, but do not tell which pixels count.
  must(render({"--background", "0,0,0", "-o", file("d.exr"), "--seed", "1"}));
  const auto clear = compared("a.exr", "b.exr"), opaque = compared("d.exr", "c.exr");
  const double shown = clear["shown"];
  EXPECT_GT(shown, 0.1);
  EXPECT_LT(shown, 0.9);
  EXPECT_FALSE(opaque.contains("shown"));
  EXPECT_NEAR(clear["metrics"]["mse"].get<double>() * shown, opaque["metrics"]["mse"].get<double>(), 1e-9);
  EXPECT_GT(clear["metrics"]["alpha"].get<double>(), 0);
  const ProcessResult mixed = run_vernier({"compare", file("a.exr"), file("c.exr")});
  EXPECT_EQ(mixed.exit_code, 2);
  EXPECT_THAT(mixed.err, HasSubstr("develop --background"));
}

TEST_F(BackgroundFlags, CropsAreThePartsOfTheWhole) {
  must(render({"--transparent", "-o", file("whole.exr")}));
  must(render({"--transparent", "-o", file("part.exr"), "--crop", "10x8+12+6"}));
  const LayeredImage whole = read_layers(file("whole.exr")), part = read_layers(file("part.exr"));
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 10; ++x)
      for (int c = 0; c < 4; ++c) ASSERT_EQ(part.image.pixel(x, y)[c], whole.image.pixel(x + 12, y + 6)[c]);
}

// The figure of the whole is that of the part which shows something.
TEST_F(BackgroundFlags, PlainBackgroundMakesNothingLookCleaner) {
  const auto error_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--zoom", "0.3",         "--env",   "none",
                                       "-o",     file("a.exr"), "--stats", file("a.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    must(render(arguments));
    return nlohmann::json::parse(read_file(file("a.json")))["error"]["rel_rmse"].get<double>();
  };
  const double whole = error_of({}), part = error_of({"--crop", "16x12+8+6"});
  EXPECT_GT(part, 0.01);
  EXPECT_NEAR(whole, part, 0.02 * part);
}

TEST_F(BackgroundFlags, AGroundIsNotSaidToBeLeftOut) {
  EXPECT_THAT(render({"--ground", "matte", "-o", file("a.exr")}).err, Not(HasSubstr("far larger")));
}

TEST_F(BackgroundFlags, AGroundIsASurface) {
  const auto alpha_below = [&](const char* ground) {
    must(render(
        {"--transparent", "--ground", ground, "--azimuth", "0", "--elevation", "30", "-o", file("a.exr")}));
    return read_layers(file("a.exr")).single("A")->pixel(2, 22)[0];
  };
  EXPECT_EQ(alpha_below("none"), 0);
  EXPECT_EQ(alpha_below("matte"), 1);
}

TEST_F(BackgroundFlags, AGroundMayBeItsShadowAlone) {
  must(render({"--transparent", "--ground", "shadow", "--env", "sky", "--elevation", "30", "--zoom", "0.5",
               "-o", file("a.exr"), "--aov", "id,crypto_object"}));
  const LayeredImage shadow = read_layers(file("a.exr"));
  must(render({"--transparent", "--env", "sky", "--elevation", "30", "--zoom", "0.5", "-o", file("b.exr")}));
  const Image with = *shadow.single("A"), without = *read_layers(file("b.exr")).single("A");
  const Image color = shadow.rgb();
  int shadowed = 0, clear = 0;
  for (size_t i = 0; i < with.values.size(); ++i) {
    EXPECT_GE(with.values[i], without.values[i] - 1e-6f);
    if (without.values[i] > 0) continue;
    shadowed += with.values[i] > 0.1f;
    clear += with.values[i] == 0;
    EXPECT_EQ(color.values[3 * i], 0) << "a shadow is black";
  }
  EXPECT_GT(shadowed, 5);
  EXPECT_GT(clear, int(with.values.size()) / 4);
}

}  // namespace
}  // namespace vernier::test
