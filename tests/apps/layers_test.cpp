// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/image/image_io.h"
#include "integrators/render/layers.h"
#include "tests/support/process.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

ProcessResult render(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"render", cornell_box, "--progress", "none", "--size", "24x24"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_vernier(arguments);
}

TEST(LayersOfAFile, EveryChannelIsThere) {
  const TemporaryFolder folder;
  const ProcessResult result = render({"--spp", "20", "--aov", "all,light", "--crop", "10x8+4+5", "-o",
                                       folder.file("a.exr"), "-o", folder.file("a.png")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const LayeredImage file = read_layers(folder.file("a.exr"));
  EXPECT_EQ(file.image.width, 10);
  EXPECT_EQ(file.image.height, 8);
  EXPECT_EQ(file.place.x, 4);
  EXPECT_EQ(file.place.y, 5);
  EXPECT_EQ(file.place.full_width, 24);
  for (const Layer& layer : layers())
    for (int c = 0; c < layer.channel_count() && layer.need != LayerNeed::motion; ++c)
      EXPECT_TRUE(file.single(std::string(layer.channels[size_t(c)]))) << layer.channels[size_t(c)];
  const Image counts = *file.single("samples");
  double samples = 0;
  for (const float count : counts.values) samples += count;
  EXPECT_NEAR(samples / 80, std::stod(file.metadata.at("vernier:samplesPerPixel")), 1e-3);
  EXPECT_EQ(read_layers(folder.file("a.png")).image.channels, 3);
}

TEST(LayersOfAFile, SameForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  std::vector<Image> images;
  for (const char* threads : {"1", "3"}) {
    ASSERT_EQ(render({"--spp", "32", "--aov", "all", "-t", threads, "-o", folder.file("a.exr")}).exit_code,
              0);
    images.push_back(read_layers(folder.file("a.exr")).image);
  }
  EXPECT_EQ(images[0].values, images[1].values);
}

TEST(LayersOfAFile, ArePartsOfAFileWhereThatIsAsked) {
  const TemporaryFolder folder;
  const std::vector<std::string> aov{"--spp", "4", "--aov", "all", "--crop", "10x8+4+5", "-o"};
  const auto make = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = aov;
    arguments.push_back(folder.file(name));
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(render(arguments).exit_code, 0);
    return read_layers(folder.file(name));
  };
  const LayeredImage flat = make("flat.exr", {}), parts = make("parts.exr", {"--multipart"});
  EXPECT_EQ(parts.channel_names.size(), flat.channel_names.size());
  for (const std::string& channel : flat.channel_names) {
    ASSERT_TRUE(parts.single(channel)) << channel;
    EXPECT_EQ(parts.single(channel)->values, flat.single(channel)->values) << channel;
  }
  EXPECT_EQ(parts.place.x, 4);
  EXPECT_EQ(parts.metadata.at("vernier:samplesPerPixel"), "4");
  EXPECT_THAT(render({"--multipart", "-o", folder.file("a.png")}).err,
              HasSubstr("--multipart: is about .exr files"));
}

TEST(LayersOfAFile, CanBeListed) {
  const ProcessResult result = run_vernier({"render", "--aov", "help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const Layer& layer : layers()) {
    EXPECT_THAT(result.out, HasSubstr(std::string(layer.name)));
    for (int c = 0; c < layer.channel_count(); ++c)
      EXPECT_THAT(result.out, HasSubstr(std::string(layer.channels[size_t(c)])));
  }
}

// The names are those of nodes and materials, under keys and channels that other programs look for.
TEST(LayersOfAFile, CryptomatteNamesWhatItShows) {
  const TemporaryFolder folder;
  ASSERT_EQ(render({"--aov", "crypto_object,crypto_material", "-o", folder.file("a.exr")}).exit_code, 0);
  const LayeredImage file = read_layers(folder.file("a.exr"));
  std::map<std::string, nlohmann::json> manifests;
  for (const auto& [key, text] : file.metadata)
    if (key.starts_with("cryptomatte/") && key.ends_with("/name")) {
      const std::string prefix = key.substr(0, key.size() - 4);
      EXPECT_EQ(prefix.size(), std::string("cryptomatte/1234567/").size());
      EXPECT_EQ(file.metadata.at(prefix + "hash"), "MurmurHash3_32");
      EXPECT_EQ(file.metadata.at(prefix + "conversion"), "uint32_to_float32");
      manifests[text] = nlohmann::json::parse(file.metadata.at(prefix + "manifest"));
    }
  ASSERT_EQ(manifests.size(), 2u);
  const auto scene = nlohmann::json::parse(read_file(cornell_box));
  std::set<std::string> nodes, materials;
  for (const auto& node : scene["nodes"]) nodes.insert(node.value("name", ""));
  for (const auto& material : scene["materials"]) materials.insert(material.value("name", ""));
  EXPECT_GE(manifests.at("CryptoObject").size(), 3u);
  for (const auto& [name, id] : manifests.at("CryptoObject").items())
    EXPECT_TRUE(nodes.contains(name)) << name;
  for (const auto& [name, id] : manifests.at("CryptoMaterial").items())
    EXPECT_TRUE(materials.contains(name)) << name;
}

TEST(LayersOfAFile, LightInPartsIsKeptByCheckpointsAndMerged) {
  const TemporaryFolder folder;
  for (const char* seed : {"1", "2"}) {
    const std::string name = folder.file(seed);
    const ProcessResult result =
        render({"--spp", "16", "--adaptive", "off", "--seed", seed, "--checkpoint", name + ".ckpt", "--aov",
                "light,error", "--light-groups", "all=light", "-o", name + ".exr"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  const ProcessResult merged = run_vernier({"merge", folder.file("1.ckpt"), folder.file("2.ckpt"), "-o",
                                            folder.file("m.exr"), "--aov", "light,light_groups,error"});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  const LayeredImage a = read_layers(folder.file("1.exr")), b = read_layers(folder.file("2.exr")),
                     both = read_layers(folder.file("m.exr"));
  for (const std::string layer : {"diffuse_direct", "diffuse_indirect", "light_all", "light_rest"}) {
    const Image x = *a.layer(layer), y = *b.layer(layer), mean = *both.layer(layer);
    for (size_t i = 0; i < mean.values.size(); ++i)
      EXPECT_NEAR(mean.values[i], (x.values[i] + y.values[i]) / 2, 1e-5f * (1 + mean.values[i])) << layer;
    EXPECT_TRUE(both.layer(layer + "_error")) << layer;
  }
  EXPECT_THAT(render({"--light-groups", "key=lihgt", "-o", folder.file("x.exr")}).err,
              HasSubstr("did you mean"));
  EXPECT_THAT(render({"--light-groups", "key=", "-o", folder.file("x.exr")}).err, HasSubstr("NAME=LIGHT"));
  EXPECT_THAT(render({"--aov", "light_groups", "-o", folder.file("x.exr")}).err, HasSubstr("--light-groups"));
  EXPECT_THAT(render({"--light-groups", "light", "-o", folder.file("x.png")}).err, HasSubstr("only an .exr"));
  EXPECT_THAT(render({"--aov", "light", "--integrator", "whitted", "-o", folder.file("x.exr")}).err,
              HasSubstr("path does"));
}

TEST(LayersOfAFile, UsageErrors) {
  const TemporaryFolder folder;
  const ProcessResult unknown = render({"--aov", "error,albdo", "-o", folder.file("a.exr")});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'albedo'"));
  const ProcessResult flat = render({"--aov", "error", "-o", folder.file("a.png")});
  EXPECT_EQ(flat.exit_code, 2);
  EXPECT_THAT(flat.err, HasSubstr("only an .exr can hold layers"));
  EXPECT_TRUE(folder.names().empty());
}

// Two renders of one picture do not differ by their own error layers; light left out shows.
TEST(LayersOfAFile, ErrorLayersServeTheBiasTest) {
  const TemporaryFolder folder;
  const auto picture = [&](const char* seed, const char* depth) {
    std::string path = folder.file(std::string(seed) + ".exr");
    EXPECT_EQ(
        render({"--spp", "64", "--aov", "error", "--seed", seed, "--max-depth", depth, "-o", path}).exit_code,
        0);
    return path;
  };
  const std::string a = picture("1", "16"), b = picture("2", "16"), c = picture("3", "3");
  const auto bias = [](const std::string& x, const std::string& y) {
    return nlohmann::json::parse(run_vernier({"compare", x, y, "--json", "--no-flip"}).out)["bias"];
  };
  EXPECT_EQ(bias(a, b)["different"], false) << bias(a, b);
  EXPECT_EQ(bias(a, c)["different"], true) << bias(a, c);
  EXPECT_GT(bias(a, c)["blocks_differing"], 3);
  EXPECT_EQ(bias(a, b)["block"], 8);
}

}  // namespace
}  // namespace vernier::test
