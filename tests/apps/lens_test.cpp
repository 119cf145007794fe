// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/image/image_io.h"
#include "tests/support/process.h"

// Lenses, pixel filters and panoramas of the command line.

namespace vernier {
namespace {

using test::cornell_box;
using test::ProcessResult;
using test::run_vernier;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// `flags` and what they do not say of `defaults`, which are pairs of a flag and its value.
std::vector<std::string> with_defaults(std::vector<std::string> flags,
                                       const std::vector<std::pair<std::string, std::string>>& defaults) {
  for (const auto& [flag, value] : defaults)
    if (std::find(flags.begin(), flags.end(), flag) == flags.end()) flags.insert(flags.end(), {flag, value});
  return flags;
}

ProcessResult render(const std::string& scene, const std::string& output, std::vector<std::string> more) {
  more = with_defaults(std::move(more), {{"--spp", "4"}, {"--progress", "none"}});
  more.insert(more.begin(), {"render", scene, "-o", output});
  return run_vernier(more);
}

/// A glowing triangle, its corners as base64 of floats.
std::string glowing_triangle(const test::TemporaryFolder& folder, const std::string& corners) {
  return folder.write("triangle.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"camera": 0, "name": "flat"}],
    "cameras": [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 9}}],
    "materials": [{"emissiveFactor": [1, 0.5, 0.25], "doubleSided": true}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)" +
                                           corners + R"("}]})");
}
/// (0,0,0), (1,0,0), (0,1,0).
const std::string card = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
/// (3,0.5,1), (3,1.5,1), (3,1,2).
const std::string to_the_right = "AABAQAAAAD8AAIA/AABAQAAAwD8AAIA/AABAQAAAgD8AAABA";

/// Looks at the card from four metres away, so that the picture is six metres wide and four high.
const std::vector<std::pair<std::string, std::string>> at_the_card{{"--look-from", "0.25,0.25,4"},
                                                                   {"--look-at", "0.25,0.25,0"},
                                                                   {"--fov", "53.13010"},
                                                                   {"--size", "48x32"},
                                                                   {"--env", "none"}};

class LensFlags : public testing::Test {
 protected:
  ProcessResult shoot(std::vector<std::string> more) {
    more.insert(more.end(), {"--stats", folder_.file("a.json")});
    return render(glowing_triangle(folder_, card), folder_.file("a.exr"), with_defaults(more, at_the_card));
  }
  nlohmann::json lens() {
    return nlohmann::json::parse(test::read_file(folder_.file("a.json")))["picture"].value("lens",
                                                                                           nlohmann::json());
  }
  /// Pixels that show something.
  int lit() {
    const Image picture = read_image(folder_.file("a.exr"));
    int count = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) count += *picture.pixel(x, y) > 0;
    return count;
  }

  const test::TemporaryFolder folder_;
};

TEST_F(LensFlags, FocalLengthFollowsFromTheAngleAndTheSensor) {
  ASSERT_EQ(shoot({}).exit_code, 0);
  EXPECT_TRUE(lens().is_null());
  ASSERT_EQ(shoot({"--fstop", "2", "--focus", "3"}).exit_code, 0);
  // Six metres wide at four: 36 mm at 24.
  EXPECT_NEAR(lens()["focal_length"], 0.024, 1e-6);
  EXPECT_EQ(lens()["fstop"], 2);
  EXPECT_EQ(lens()["focus_distance"], 3);
  const auto header = read_layers(folder_.file("a.exr")).metadata;
  EXPECT_EQ(header.at("vernier:lens"), "24 mm f/2, focused at 3 m");
  ASSERT_EQ(shoot({"--fstop", "2", "--focus", "3", "--sensor", "18"}).exit_code, 0);
  EXPECT_NEAR(lens()["focal_length"], 0.012, 1e-6);
  ASSERT_EQ(shoot({"--fstop", "2", "--size", "32x48"}).exit_code, 0);
  // The longer side is the upright one now, four metres high at four.
  EXPECT_NEAR(lens()["focal_length"], 0.036, 1e-6);
  ASSERT_EQ(shoot({"--fstop", "2", "--focus", "inf"}).exit_code, 0);
  EXPECT_TRUE(lens()["focus_distance"].is_null());
}

TEST_F(LensFlags, FocusesOnWhatIsSeen) {
  const ProcessResult unsaid = shoot({"--fstop", "0.02"});
  EXPECT_EQ(unsaid.exit_code, 0);
  EXPECT_THAT(unsaid.err, AllOf(HasSubstr("focused 4 m away"), HasSubstr("--focus METRES")));
  EXPECT_NEAR(lens()["focus_distance"], 4, 1e-4);
  const int sharp = lit();
  EXPECT_THAT(shoot({"--fstop", "0.02", "--focus", "auto"}).err, Not(HasSubstr("focused")));
  EXPECT_EQ(lit(), sharp);
  ASSERT_EQ(shoot({"--fstop", "0.02", "--focus", "24,16"}).exit_code, 0);
  EXPECT_NEAR(lens()["focus_distance"], 4, 1e-4) << "along the axis, not along the ray";
  EXPECT_EQ(lit(), sharp);
  ASSERT_EQ(shoot({"--fstop", "0.02", "--focus", "2"}).exit_code, 0);
  EXPECT_GT(lit(), 2 * sharp);
  // Where the middle shows nothing, it is what lies nearest to it.
  ASSERT_EQ(shoot({"--fstop", "0.02", "--look-at", "1.5,0.25,0"}).exit_code, 0);
  EXPECT_NEAR(lens()["focus_distance"], 3.9, 0.3);
  const ProcessResult nothing = shoot({"--fstop", "0.02", "--look-at", "0,0,9"});
  EXPECT_THAT(nothing.err, HasSubstr("focused at infinity"));
}

TEST_F(LensFlags, WrongValuesAreRefusedInOneLine) {
  const auto refused = [&](const std::vector<std::string>& flags) {
    const ProcessResult result = render(glowing_triangle(folder_, card), folder_.file("a.exr"), flags);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
    return result.err;
  };
  EXPECT_THAT(refused({"--fstop", "0"}), HasSubstr("--fstop"));
  EXPECT_THAT(refused({"--fstop", "f2"}), HasSubstr("'f2' is not a number"));
  EXPECT_THAT(refused({"--focus", "2"}), HasSubstr("--focus needs --fstop"));
  EXPECT_THAT(refused({"--sensor", "24"}), HasSubstr("--sensor needs --fstop"));
  for (const char* focus : {"0", "near", "1,2,3", "-1,2", "nan"})
    EXPECT_THAT(refused({"--fstop", "2", std::string("--focus=") + focus}), HasSubstr("nothing to focus on"));
  EXPECT_THAT(refused({"--fstop", "2", "--azimuth", "0", "--size", "48x32", "--focus", "48,3"}),
              HasSubstr("outside of the picture of 48x32"));
  EXPECT_THAT(refused({"--fstop", "2", "--azimuth", "0", "--size", "48x32", "--focus", "0,0"}),
              HasSubstr("shows no surface"));
  EXPECT_THAT(refused({"--fstop", "2"}), HasSubstr("camera flat is orthographic"));
  EXPECT_THAT(refused({"--fstop", "2", "--ortho"}), AllOf(HasSubstr("--ortho"), HasSubstr("--fstop")));
  EXPECT_THAT(refused({"--sensor", "0", "--fstop", "2"}), HasSubstr("--sensor"));
  EXPECT_THAT(refused({"--filter", "gausian"}), HasSubstr("did you mean 'gaussian'"));
  EXPECT_THAT(refused({"--filter", "gaussian:99"}), HasSubstr("expected 0.1 to 16"));
  for (const std::string flag : {"--fov=20", "--zoom=2", "--ortho", "--fstop=2", "--roll=3"})
    EXPECT_THAT(refused({"--panorama", flag}),
                AllOf(HasSubstr("--panorama"), HasSubstr(flag.substr(0, flag.find('=')))));
}

TEST_F(LensFlags, FiltersAreListedTakenAndPartOfACheckpoint) {
  EXPECT_THAT(run_vernier({"render", "--filter", "help"}).out,
              AllOf(HasSubstr("box"), HasSubstr("gaussian"), HasSubstr("blackman-harris")));
  ASSERT_EQ(shoot({}).exit_code, 0);
  const int box = lit();
  ASSERT_EQ(shoot({"--filter", "gaussian:6", "--checkpoint", folder_.file("a.ckpt")}).exit_code, 0);
  EXPECT_GT(lit(), box);
  EXPECT_EQ(read_layers(folder_.file("a.exr")).metadata.at("vernier:filter"), "gaussian:6");
  EXPECT_THAT(shoot({"--filter", "gaussian:5", "--resume", folder_.file("a.ckpt")}).err,
              HasSubstr("filter was gaussian:6, is gaussian:5"));
  EXPECT_THAT(shoot({"--filter", "gaussian:6", "--fstop", "9", "--resume", folder_.file("a.ckpt")}).err,
              HasSubstr("camera was"));
}

/// Where the light of a picture is, and how much of it there is, second channel.
struct Light {
  double x = 0, y = 0, sum = 0;
};

Light light_in(const Image& picture) {
  Light light;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double value = picture.pixel(x, y)[1];
      light.sum += value;
      light.x += value * x;
      light.y += value * y;
    }
  return {light.x / light.sum, light.y / light.sum, light.sum};
}

// What a panorama shows around its camera is what a camera in an empty scene sees of it.
TEST(Panorama, IsWhatEnvTakes) {
  const test::TemporaryFolder folder;
  const std::string scene = glowing_triangle(folder, to_the_right);
  const std::string empty = folder.write("empty.gltf", R"({"asset": {"version": "2.0"}})");
  const std::string panorama = folder.file("panorama.exr");
  ASSERT_EQ(
      render(scene, panorama, {"--panorama", "--look-from", "0,0,0", "--env", "none", "--size", "256x128"})
          .exit_code,
      0);
  const std::vector<std::string> view{"--look-from", "0,0,0", "--look-at", "3,1.2,1",
                                      "--fov",       "50",    "--size",    "48x36"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), view.begin(), view.end());
    return more;
  };
  ASSERT_EQ(render(scene, folder.file("a.exr"), with({"--env", "none", "--spp", "16"})).exit_code, 0);
  ASSERT_EQ(render(empty, folder.file("b.exr"), with({"--env", panorama})).exit_code, 0);
  const Light seen = light_in(read_image(folder.file("a.exr")));
  const Light shown = light_in(read_image(folder.file("b.exr")));
  ASSERT_GT(seen.sum, 10);
  EXPECT_NEAR(shown.sum / seen.sum, 1, 0.06);
  EXPECT_NEAR(shown.x, seen.x, 0.3);
  EXPECT_NEAR(shown.y, seen.y, 0.3);
}

TEST(Panorama, IsTwiceAsWideAsHighAndSeesAllAroundFromItsCamera) {
  const test::TemporaryFolder folder;
  const std::string output = folder.file("out.exr");
  ASSERT_EQ(render(cornell_box, output,
                   {"--panorama", "--look-from", "0.28,0.45,0.28", "--spp", "1", "--aov", "depth,coverage"})
                .exit_code,
            0);
  const LayeredImage picture = read_layers(output);
  EXPECT_EQ(picture.image.width, 1280);
  EXPECT_EQ(picture.image.height, 640);
  // The box is open at the front, toward -z, where the camera sees nothing.
  const Image depth = *picture.single("Z"), coverage = *picture.single("coverage");
  EXPECT_TRUE(std::isinf(*depth.pixel(320, 320)));
  EXPECT_EQ(*coverage.pixel(320, 320), 0);
  for (const int column : {0, 640, 960}) EXPECT_NEAR(*depth.pixel(column, 320), 0.28, 0.01) << column;
}

}  // namespace
}  // namespace vernier
