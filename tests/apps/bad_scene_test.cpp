// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"

// What the program does with scenes that cannot be read; what is wrong in which way is tested with the
// importer.

namespace vernier {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Both render and info refuse the file with exit code 3 and one line that names it, and write nothing.
void expect_refused(const test::TemporaryFolder& folder, const std::string& scene, const std::string& text) {
  const std::vector<std::string> before = folder.names();
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"render", scene, "-o", folder.file("out.exr"), "--stats",
                                 folder.file("out.json")},
        std::vector<std::string>{"info", scene}}) {
    const test::ProcessResult result = test::run_vernier(arguments);
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
    EXPECT_THAT(result.err, StartsWith("error: "));
    EXPECT_THAT(result.err, HasSubstr(scene));
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_EQ(result.out, "");
  }
  EXPECT_EQ(folder.names(), before);
}

const char minimal[] = R"({"asset": {"version": "2.0"})";

TEST(BadScene, Missing) {
  const test::TemporaryFolder folder;
  expect_refused(folder, folder.file("missing.glb"), "");
  expect_refused(folder, folder.path().string(), "");
}

TEST(BadScene, EmptyOrNotGltf) {
  const test::TemporaryFolder folder;
  expect_refused(folder, folder.write("empty.gltf", ""), "");
  expect_refused(folder, folder.write("empty.glb", ""), "");
  expect_refused(folder, folder.write("words.gltf", "# not JSON\n"), "");
  expect_refused(folder, folder.write("words.glb", "glFT something else"), "");
}

TEST(BadScene, JsonThatEndsEarly) {
  const test::TemporaryFolder folder;
  expect_refused(folder, folder.write("cut.gltf", minimal), "");
}

TEST(BadScene, GlbCutAnywhere) {
  const test::TemporaryFolder folder;
  std::string json = std::string(minimal) + "}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](size_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
    return bytes;
  };
  const std::string glb = "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
  EXPECT_EQ(test::run_vernier({"info", folder.write("whole.glb", glb)}).exit_code, 0);
  for (const size_t length : {size_t{3}, size_t{11}, size_t{12}, size_t{19}, size_t{20}, glb.size() - 1})
    expect_refused(folder, folder.write("cut.glb", glb.substr(0, length)), "");
}

TEST(BadScene, RequiredExtensionIsNamed) {
  const test::TemporaryFolder folder;
  expect_refused(
      folder,
      folder.write("future.gltf",
                   std::string(minimal) +
                       R"(, "extensionsUsed": ["KHR_tomorrow"], "extensionsRequired": ["KHR_tomorrow"]})"),
      "KHR_tomorrow");
}

TEST(BadScene, MissingBufferIsNamed) {
  const test::TemporaryFolder folder;
  expect_refused(
      folder,
      folder.write("lost.gltf", std::string(minimal) + R"(, "buffers": [{"byteLength": 4, "uri": "lost.bin"}],
          "bufferViews": [{"buffer": 0, "byteLength": 4}], "accessors": [{"bufferView": 0, "componentType": 5126,
          "count": 1, "type": "SCALAR"}]})"),
      "lost.bin");
}

TEST(BadScene, UsedButUnknownExtensionIsAWarningAndStrictRefusesIt) {
  const test::TemporaryFolder folder;
  const std::string scene =
      folder.write("curious.gltf", std::string(minimal) + R"(, "extensionsUsed": ["KHR_tomorrow"]})");
  const test::ProcessResult info = test::run_vernier({"info", scene});
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_THAT(info.err, testing::AllOf(HasSubstr("warning: "), HasSubstr("KHR_tomorrow")));
  const test::ProcessResult strict = test::run_vernier({"info", scene, "--strict"});
  EXPECT_EQ(strict.exit_code, 3);
  EXPECT_THAT(strict.err, testing::AllOf(StartsWith("error: "), HasSubstr("KHR_tomorrow")));
}

const std::string two_cameras = std::string(minimal) + R"(,
    "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
    "nodes": [{"camera": 0, "scale": [0, 0, 0], "name": "flat"}, {"camera": 0, "name": "good"}]})";

TEST(BadScene, ACameraThatLooksNowhereIsNamedWhenItIsTheOneUsed) {
  const test::TemporaryFolder folder;
  const std::string scene = folder.write("flat.gltf", two_cameras);
  const auto render = [&](const std::string& camera) {
    return test::run_vernier(
        {"render", scene, "-o", folder.file("out.exr"), "--size", "4x4", "--spp", "1", "--camera", camera});
  };
  const test::ProcessResult flat = render("flat");
  EXPECT_EQ(flat.exit_code, 3);
  EXPECT_EQ(flat.err_lines().size(), 1u) << flat.err;
  EXPECT_THAT(flat.err,
              StartsWith("error: " + scene + ": /nodes/0: the camera 'flat' of the node 'flat' cannot be"));
  const test::ProcessResult good = render("good");
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_THAT(good.err, HasSubstr("/nodes/0: the camera 'flat'"));
}

TEST(BadScene, FilesOutsideTheFolderAreReadWhenAllowed) {
  const test::TemporaryFolder folder;
  const std::string scene = folder.write("scene/outside.gltf", std::string(minimal) + R"(,
      "buffers": [{"byteLength": 4, "uri": "../data.bin"}]})");
  folder.write("data.bin", "1234");
  expect_refused(folder, scene, "--allow-outside-files");
  EXPECT_EQ(test::run_vernier({"info", scene, "--allow-outside-files"}).exit_code, 0);
}

TEST(BadScene, NothingOfAFileReachesTheTerminalAsItIs) {
  const test::TemporaryFolder folder;
  const std::string scene = folder.write("names.gltf", std::string(minimal) + R"(,
      "materials": [{"name": "a\u001b[2Jb\u009b1m"}], "cameras": [{"name": "c\nd", "type": "perspective",
      "perspective": {"yfov": 1, "znear": 1}}], "nodes": [{"camera": 0}]})");
  const test::ProcessResult info = test::run_vernier({"info", scene});
  EXPECT_EQ(info.exit_code, 0);
  for (const std::string& text : {info.out, info.err}) {
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    EXPECT_EQ(text.find("\xC2\x9B"), std::string::npos);
  }
  const std::string utf16 = folder.write("utf16.gltf", "\xFF\xFE{\0");
  expect_refused(folder, utf16, "UTF-16");
}

}  // namespace
}  // namespace vernier
