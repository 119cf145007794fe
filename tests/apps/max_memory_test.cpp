// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/image/image_io.h"
#include "tests/scene/import_support.h"
#include "tests/support/png_bytes.h"
#include "tests/support/process.h"

// --max-memory on the command line.

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr uint32_t side = 2048;
constexpr int images = 12;
constexpr double texture_bytes = double(images) * side * side * 3;

/// Walls in a row, each with an image of its own, whose files are one file. What is decoded is 151 MB.
std::string textured_walls(const TemporaryFolder& folder) {
  GltfFile file;
  PngSource picture{side, side};
  picture.samples.resize(size_t(side) * side * 3);
  for (size_t i = 0; i < picture.samples.size(); ++i) picture.samples[i] = uint8_t(i * 2654435761u >> 13);
  const std::vector<uint8_t> png = png_bytes(picture);
  folder.write("noise.png", std::string(png.begin(), png.end()));
  const json attributes = {
      {"POSITION", file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")},
      {"TEXCOORD_0", file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2")}};
  for (int i = 0; i < images; ++i) {
    file.add("images", {{"uri", "noise.png"}});
    file.add("textures", {{"source", i}});
    file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    const int wall = file.add_mesh(attributes, {{"material", i}});
    file.json["nodes"][size_t(wall)]["translation"] = {i % 4, i / 4, 0};
  }
  return file.save(folder);
}

class MaxMemory : public testing::Test {
 protected:
  ProcessResult render(const std::string& scene, const std::vector<std::string>& more,
                       const std::string& size = "160x120") {
    std::vector<std::string> all{"render",     scene,
                                 "-o",         folder_.file("a.exr"),
                                 "--stats",    folder_.file("stats.json"),
                                 "--size",     size,
                                 "--spp",      "4",
                                 "--env",      "studio",
                                 "--progress", "none",
                                 "--threads",  "2"};
    all.insert(all.end(), more.begin(), more.end());
    return run_vernier(all);
  }
  json stats() const { return json::parse(read_file(folder_.file("stats.json"))); }
  std::vector<float> picture() const { return read_image(folder_.file("a.exr")).values; }

  const TemporaryFolder folder_;
};

TEST_F(MaxMemory, RendersTheSamePictureInLess) {
  const std::string scene = textured_walls(folder_);
  for (const std::vector<std::string>& flags : {std::vector<std::string>{}, {"--texture-filter", "mip"}}) {
    const ProcessResult plain = render(scene, flags);
    ASSERT_EQ(plain.exit_code, 0) << plain.err;
    const json before = stats();
    const std::vector<float> expected = picture();
    EXPECT_EQ(before["scene"]["counts"]["texture_bytes"], texture_bytes);
    EXPECT_EQ(before["scene"]["counts"]["texture_bytes_in_file"], 0);
    const double peak = before["peak_memory_bytes"].get<double>();

    const double most = peak - texture_bytes / 2;
    std::vector<std::string> limited = flags;
    limited.insert(limited.end(), {"--max-memory", std::to_string(uint64_t(most))});
    const ProcessResult tight = render(scene, limited);
    ASSERT_EQ(tight.exit_code, 0) << tight.err;
    EXPECT_EQ(picture(), expected);
    EXPECT_THAT(tight.err, HasSubstr("they are kept in a file in "));
    EXPECT_EQ(stats()["scene"]["counts"]["texture_bytes_in_file"], texture_bytes);
#ifndef VERNIER_SANITIZED
    EXPECT_LE(stats()["peak_memory_bytes"].get<double>(), most) << "of " << peak << " without";
#endif
  }
}

TEST_F(MaxMemory, IsNotToldWhereAllFits) {
  const ProcessResult result = render(two_spheres, {"--max-memory", "1T"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, Not(HasSubstr("file in")));
}

TEST_F(MaxMemory, RefusesWhatCannotBeDoneWithIt) {
  const ProcessResult scene = render(two_spheres, {"--max-memory", "20 MB"}, "16x16");
  EXPECT_EQ(scene.exit_code, 4) << scene.err;
  EXPECT_THAT(scene.err, HasSubstr("--max-memory is 20.0 MB"));
  const ProcessResult picture = render(two_spheres, {"--max-memory", "2GiB"}, "8192x8192");
  EXPECT_EQ(picture.exit_code, 4) << picture.err;
  EXPECT_THAT(picture.err, HasSubstr("a picture of 67.1 M pixels needs "));
  EXPECT_THAT(picture.err, HasSubstr("--max-memory is 2.15 GB"));
}

TEST_F(MaxMemory, RefusesPicturesAroundAndBehindASceneBeforeTheyAreRead) {
  const std::string sky = folder_.file("sky.hdr");
  std::ofstream(sky) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4096 +X 8192\n";
  for (const char* flag : {"--env", "--background"}) {
    const ProcessResult result = run_vernier({"render", two_spheres, "-o", folder_.file("a.exr"), "--size",
                                              "16x16", flag, sky, "--max-memory", "1G"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_THAT(result.err, HasSubstr("image of 8192x4096 pixels is larger than the limit of ")) << flag;
    EXPECT_THAT(result.err, HasSubstr("raise --max-memory")) << flag;
  }
}

TEST_F(MaxMemory, TakesAmountsAlone) {
  for (const char* wrong : {"0", "-1G", "2X", "", "1e30", "G"}) {
    const ProcessResult result = render(two_spheres, {"--max-memory", wrong});
    EXPECT_EQ(result.exit_code, 2) << wrong;
    EXPECT_THAT(result.err, HasSubstr("is not an amount of memory")) << wrong;
  }
}

TEST_F(MaxMemory, SaysWhereNoFileCanBe) {
  const std::string scene = textured_walls(folder_);
  setenv("TMPDIR", folder_.file("missing").c_str(), 1);
  const ProcessResult result = render(scene, {"--max-memory", "250M"});
  unsetenv("TMPDIR");
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_THAT(result.err, HasSubstr("missing: no file for textures can be made"));
}

}  // namespace
}  // namespace vernier::test
