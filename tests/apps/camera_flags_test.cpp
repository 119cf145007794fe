// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/image/image_io.h"
#include "tests/support/process.h"

// Cameras of the command line, told by where things come out in pictures.

namespace vernier {
namespace {

using test::cornell_box;
using test::ProcessResult;
using test::run_vernier;
using testing::AllOf;
using testing::HasSubstr;

constexpr int width = 96, height = 64;

ProcessResult render(const std::string& scene, const std::string& output, std::vector<std::string> more) {
  more.insert(more.begin(), {"render", scene, "-o", output, "--progress", "none", "--integrator", "raycast",
                             "--show", "albedo", "--size", "96x64", "--spp", "4"});
  return run_vernier(more);
}

/// Columns and rows of the picture in which something is seen, from 0 to 1.
struct Seen {
  double left = 1, right = 0, top = 1, bottom = 0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

/// One triangle (0,0,0), (1,0,0), (0,1,0), white, double-sided.
std::string card(const test::TemporaryFolder& folder) {
  return folder.write("card.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0}, {"camera": 0, "name": "own", "translation": [0.5, 0.5, 9]}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 1.5, "znear": 0.1}}],
    "materials": [{"doubleSided": true}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                   "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36,
                 "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
}

Seen seen(const std::vector<std::string>& flags) {
  const test::TemporaryFolder folder;
  const ProcessResult result = render(card(folder), folder.file("out.exr"), flags);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  Seen seen;
  if (result.exit_code != 0) return seen;
  const Image picture = read_image(folder.file("out.exr"));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (*picture.pixel(x, y) > 0.1f) {
        seen.left = std::min(seen.left, double(x) / width);
        seen.right = std::max(seen.right, double(x + 1) / width);
        seen.top = std::min(seen.top, double(y) / height);
        seen.bottom = std::max(seen.bottom, double(y + 1) / height);
      }
  return seen;
}

constexpr double pixel = 1.5 / height;

TEST(CameraFlags, FitFillsThePictureUpToTheMargin) {
  for (const auto& [flag, margin] : {std::pair("8%", 0.08), std::pair("0.25", 0.25), std::pair("0", 0.0)}) {
    const Seen card = seen({"--fit", flag});
    EXPECT_NEAR(card.top, margin, pixel) << flag;
    EXPECT_NEAR(card.bottom, 1 - margin, pixel) << flag;
    EXPECT_NEAR(card.left, 1 - card.right, 2 * pixel) << flag;
  }
}

TEST(CameraFlags, TheScenesCameraIsTakenUnlessAnotherIsAskedFor) {
  EXPECT_LT(seen({}).height(), 0.1);
  EXPECT_LT(seen({"--camera", "own"}).height(), 0.1);
  EXPECT_NEAR(seen({"--azimuth", "20"}).height(), 0.84, 0.1);
}

TEST(CameraFlags, AzimuthAndElevationGoAroundTheScene) {
  const double front = seen({"--azimuth", "0", "--elevation", "0"}).width();
  EXPECT_NEAR(front, 0.84 * height / width, pixel);
  EXPECT_NEAR(seen({"--azimuth", "60", "--elevation", "0"}).width(), front / 2, 0.06);
  const Seen above = seen({"--azimuth", "0", "--elevation", "60"});
  EXPECT_GT(above.width() * width, 1.4 * above.height() * height);
  // From behind, the corner at the left of the front is at the right: the picture is the same but mirrored,
  // and rolled by half a turn it is upside down.
  EXPECT_NEAR(seen({"--azimuth", "180", "--elevation", "0"}).width(), front, pixel);
}

TEST(CameraFlags, LookFromLookAtAndFov) {
  // At distance 2 a picture of 90 degrees is 4 metres high.
  const Seen card = seen({"--look-from", "0.5,0.5,2", "--look-at", "0.5,0.5,0", "--fov", "90"});
  EXPECT_NEAR(card.height(), 0.25, pixel);
  EXPECT_NEAR((card.top + card.bottom) / 2, 0.5, pixel);
  EXPECT_NEAR(seen({"--look-from", "0.5,0.5,2", "--fov", "90", "--zoom", "2"}).height(), 0.5, pixel);
  const Seen from_behind =
      seen({"--look-from", "-0.5,0.5,-2", "--look-at", "-0.5,0.5,0", "--fov", "90", "--up", "0,1,0"});
  EXPECT_LT(from_behind.right, 0.5);  // what lies toward +x is at the left
}

TEST(CameraFlags, Orthographic) {
  EXPECT_NEAR(seen({"--azimuth", "0", "--elevation", "0", "--ortho", "4"}).height(), 0.25, pixel);
  EXPECT_NEAR(seen({"--azimuth", "0", "--elevation", "0", "--ortho"}).height(), 0.84, pixel);
  EXPECT_NEAR(seen({"--azimuth", "0", "--elevation", "0", "--ortho=4", "--zoom", "2"}).height(), 0.5, pixel);
}

TEST(CameraFlags, RollTurnsAnyCamera) {
  const Seen upright = seen({"--azimuth", "0", "--elevation", "0"});
  const Seen rolled = seen({"--azimuth", "0", "--elevation", "0", "--roll", "45"});
  EXPECT_GT(rolled.width(), 1.1 * upright.width());
  // Half a square on its diagonal is twice as wide as high.
  EXPECT_NEAR(rolled.width(), 0.84, 2 * pixel);
  EXPECT_NEAR(rolled.height(), 0.84 * 1.5 / 2, 2 * pixel);
  EXPECT_GT(seen({"--roll", "45", "--zoom", "8"}).height(), 0.1);
}

TEST(CameraFlags, StatsTellTheViewAsFlagsThatShowTheSameAgain) {
  for (const std::vector<std::string>& flags : {std::vector<std::string>{},
                                                {"--azimuth", "20", "--elevation", "50"},
                                                {"--roll", "30", "--fov", "20"},
                                                {"--azimuth", "-40", "--ortho"}}) {
    const test::TemporaryFolder folder;
    std::vector<std::string> fitted{"--azimuth=25", "--stats", folder.file("stats.json")};
    if (!flags.empty()) fitted.erase(fitted.begin());
    fitted.insert(fitted.end(), flags.begin(), flags.end());
    const Seen asked = seen(fitted);
    const auto view = nlohmann::json::parse(test::read_file(folder.file("stats.json")))["picture"]["view"];
    std::vector<std::string> again;
    for (const auto& [flag, key] :
         {std::pair("--look-from=", "from"), std::pair("--look-at=", "at"), std::pair("--up=", "up")})
      again.push_back(fmt::format("{}{}", flag, fmt::join(view[key].get<std::vector<double>>(), ",")));
    const std::string lens = view.contains("ortho") ? "ortho" : "fov";
    again.push_back(fmt::format("--{}={}", lens, view[lens].get<double>()));
    const Seen shown = seen(again);
    for (const auto& [a, b] : {std::pair(asked.left, shown.left), std::pair(asked.right, shown.right),
                               std::pair(asked.top, shown.top), std::pair(asked.bottom, shown.bottom)})
      EXPECT_NEAR(a, b, pixel / 2) << fmt::format("{}", fmt::join(again, " "));
  }
}

TEST(CameraFlags, ContradictionsAreRefusedInOneLine) {
  const test::TemporaryFolder folder;
  const auto refused = [&](const std::vector<std::string>& flags) {
    const ProcessResult result = render(cornell_box, folder.file("out.exr"), flags);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
    return result.err;
  };
  EXPECT_THAT(refused({"--look-from", "1,2,3", "--azimuth", "20"}),
              AllOf(HasSubstr("--look-from"), HasSubstr("--azimuth")));
  EXPECT_THAT(refused({"--camera", "0", "--elevation", "20"}), HasSubstr("--elevation"));
  EXPECT_THAT(refused({"--camera", "0", "--fit", "5%"}), HasSubstr("--zoom"));
  EXPECT_THAT(refused({"--look-at", "1,2,3"}), HasSubstr("--look-from"));
  EXPECT_THAT(refused({"--ortho", "2", "--fov", "20"}), HasSubstr("--ortho HEIGHT"));
  EXPECT_THAT(refused({"--look-from", "1,2"}), HasSubstr("three numbers"));
  EXPECT_THAT(refused({"--look-from", "1,2,3", "--look-at", "1,2,3"}), HasSubstr("point looked at"));
  EXPECT_THAT(refused({"--look-from", "0,3,0", "--look-at", "0,0,0", "--up", "0,1,0"}), HasSubstr("--up"));
  EXPECT_THAT(refused({"--fov", "180"}), HasSubstr("179"));
  EXPECT_THAT(refused({"--fit", "60%"}), HasSubstr("45 %"));
  EXPECT_THAT(refused({"--ortho", "x"}), HasSubstr("height"));
  EXPECT_THAT(refused({"--azimut", "20"}), HasSubstr("did you mean '--azimuth'"));
}

TEST(CameraFlags, ACheckpointBelongsToItsCamera) {
  const test::TemporaryFolder folder;
  const auto go_on = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> all{"--checkpoint", folder.file("a.ckpt"), "--resume", folder.file("a.ckpt")};
    all.insert(all.end(), flags.begin(), flags.end());
    return render(cornell_box, folder.file("out.exr"), all);
  };
  EXPECT_EQ(go_on({"--azimuth", "200"}).exit_code, 0);
  EXPECT_EQ(go_on({"--azimuth", "200"}).exit_code, 0);
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{}, {"--azimuth", "201"}, {"--azimuth", "200", "--zoom", "1.1"}}) {
    const ProcessResult result = go_on(other);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_THAT(result.err, HasSubstr("camera"));
  }
}

}  // namespace
}  // namespace vernier
