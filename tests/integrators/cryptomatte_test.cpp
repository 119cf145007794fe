// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/cryptomatte.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "integrators/render/layers.h"
#include "tests/support/test_scenes.h"
#include "vernier/session.h"

namespace vernier::test {
namespace {

// Values of MurmurHash3_x86_32 that its users publish, and two whose exponent is that of no normal number.
TEST(Cryptomatte, HashesNamesByMurmurHash3) {
  EXPECT_EQ(cryptomatte_hash("hello"), 0x248bfa47u);
  EXPECT_EQ(cryptomatte_hash("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(cryptomatte_hash("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
  EXPECT_EQ(cryptomatte_hash("ab"), 0x9bbfd75fu);
  EXPECT_EQ(cryptomatte_hash("test"), 0xba6bd213u);
  EXPECT_EQ(cryptomatte_hash("\xc3\x9cn\xc3\xaf"
                             "code"),
            0xf095bc36u);
  EXPECT_EQ(cryptomatte_hash("object 259"), 0x0069b367u ^ 1u << 23);
  EXPECT_EQ(cryptomatte_hash("object 858"), 0xff868043u ^ 1u << 23);
  for (int i = 0; i < 10000; ++i)
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(cryptomatte_hash("object " + std::to_string(i)))));
}

/// Ten cards side by side in front of the camera, of three materials in turn, the last half transparent.
std::shared_ptr<const Scene> cards() {
  SceneBuilder builder;
  for (int i = 0; i < 10; ++i) {
    MaterialDescription material = diffuse(0.5f);
    material.name = "paint " + std::to_string(i % 3);
    if (i == 9) {
      material.base_color.w = 0.5f;
      material.alpha_mode = AlphaMode::blend;
    }
    const float x = float(i) - 5;
    builder.add(parallelogram({x, -5, -10}, {1, 0, 0}, {0, 10, 0}), material);
  }
  SceneDescription description = builder.description();
  for (size_t i = 0; i < 10; ++i) {
    description.instances[i].name = "card " + std::to_string(i);
    description.instances[i].asset = i < 5 ? "left" : "right";
  }
  return build_scene(std::move(description));
}

using Mattes = std::map<std::string, double>;

/// Names and parts of a pixel, by the manifest.
Mattes mattes(const LayeredImage& picture, const std::string& layer, int x, int y) {
  std::map<uint32_t, std::string> names;
  for (const auto& [key, text] : picture.metadata) {
    if (!key.ends_with("/name") || text != layer) continue;
    const auto manifest =
        nlohmann::json::parse(picture.metadata.at(key.substr(0, key.size() - 4) + "manifest"));
    for (const auto& [name, id] : manifest.items())
      names[uint32_t(std::stoul(id.get<std::string>(), nullptr, 16))] = name;
  }
  Mattes found;
  double last = 1;
  for (int rank = 0; rank < cryptomatte_ranks; ++rank) {
    const std::string channel = layer + "0" + std::to_string(rank / 2) + (rank % 2 ? ".b" : ".r");
    const std::string part = layer + "0" + std::to_string(rank / 2) + (rank % 2 ? ".a" : ".g");
    const float id = *picture.single(channel)->pixel(x, y), share = *picture.single(part)->pixel(x, y);
    EXPECT_LE(share, last);
    last = share;
    if (share > 0) found[names.at(std::bit_cast<uint32_t>(id))] += share;
  }
  return found;
}

LayeredImage picture_of(const std::shared_ptr<const Scene>& scene, int width, float yfov) {
  RenderSettings settings;
  settings.width = width;
  settings.height = 4;
  settings.camera.yfov = yfov;
  settings.adaptive = false;
  RenderSession session(scene, settings);
  session.run();
  return session.picture("crypto_object,crypto_material,crypto_asset,coverage");
}

TEST(Cryptomatte, TellsThePartsOfAPixelByName) {
  // At ten metres a pixel is 1.25 m wide; the first begins at -5.
  const LayeredImage picture = picture_of(cards(), 8, 2 * std::atan(0.25f));
  const Mattes first = mattes(picture, "CryptoObject", 0, 1);
  EXPECT_EQ(first.size(), 2u);
  EXPECT_NEAR(first.at("card 0"), 0.8, 0.04);
  EXPECT_NEAR(first.at("card 1"), 0.2, 0.04);
  EXPECT_EQ(mattes(picture, "CryptoMaterial", 0, 1).size(), 2u);
  EXPECT_EQ(mattes(picture, "CryptoAsset", 0, 1), (Mattes{{"left", 1}}));
  const Mattes last = mattes(picture, "CryptoObject", 7, 1);
  EXPECT_NEAR(last.at("card 9"), 0.4, 0.15) << "it lets half of what it covers through";
  EXPECT_NEAR(last.at("card 8"), 0.2, 0.04);
}

TEST(Cryptomatte, PartsOfOneNameAreOneAndTheSmallestAreDropped) {
  // All ten cards in one pixel, and something beside them.
  const LayeredImage picture = picture_of(cards(), 1, 2 * std::atan(2.4f));
  EXPECT_EQ(mattes(picture, "CryptoObject", 0, 1).size(), size_t(cryptomatte_ranks));
  const Mattes paints = mattes(picture, "CryptoMaterial", 0, 1);
  EXPECT_EQ(paints.size(), 3u);
  const Mattes assets = mattes(picture, "CryptoAsset", 0, 1);
  EXPECT_EQ(assets.size(), 2u);
  double sum = 0;
  for (const auto& [name, part] : assets) sum += part;
  EXPECT_NEAR(sum, 10 / 12. * 5 / 12., 0.05)
      << "the row is twelve metres high and wide, half of them above the cards";
}

}  // namespace
}  // namespace vernier::test
