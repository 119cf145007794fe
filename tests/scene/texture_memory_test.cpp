// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "materials/texture_pixels.h"
#include "tests/scene/import_support.h"
#include "tests/support/png_bytes.h"

// Where an import leaves textures when memory is limited.

namespace vernier::test {
namespace {

using nlohmann::json;

constexpr uint32_t width = 300, height = 200;

PngSource noise(int colour_type, int bit_depth) {
  PngSource picture{width, height, bit_depth, colour_type};
  const size_t channels = colour_type == 6 ? 4 : 3;
  picture.samples.resize(width * height * channels * size_t(bit_depth / 8));
  for (size_t i = 0; i < picture.samples.size(); ++i) picture.samples[i] = uint8_t(i * 2654435761u >> 11);
  return picture;
}

/// A triangle with a texture of eight bits, one of sixteen, and a glossiness, of which a roughness is made.
GltfFile textured() {
  GltfFile file;
  const json attributes = {{"POSITION", file.add_accessor(GltfFile::triangle_positions(), "VEC3")},
                           {"TEXCOORD_0", file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2")}};
  for (const PngSource& picture : {noise(2, 8), noise(2, 16), noise(6, 8)}) {
    const int image = file.add("images", {{"bufferView", file.add_view(png_bytes(picture))}});
    file.add("textures", {{"source", image}});
  }
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                         {"emissiveTexture", {{"index", 1}}}});
  file.add("materials",
           {{"extensions",
             {{"KHR_materials_pbrSpecularGlossiness", {{"specularGlossinessTexture", {{"index", 2}}}}}}}});
  file.json["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  for (const int material : {0, 1}) file.add_mesh(attributes, {{"material", material}});
  return file;
}

SceneDescription import(const MemoryLimit& limit) {
  ImportOptions options;
  options.memory = limit;
  return textured().import(options);
}

TEST(TextureMemory, LeavesTexturesInAFileWhereThereIsNoRoom) {
  const SceneDescription plain = import({}), tight = import({.bytes = 1});
  ASSERT_EQ(plain.textures.size(), 4u);
  ASSERT_EQ(tight.textures.size(), 4u);
  EXPECT_EQ(tight.hash, plain.hash);
  EXPECT_TRUE(has_notice(tight, "they are kept in a file"));
  EXPECT_FALSE(has_notice(plain, "they are kept in a file"));
  const std::shared_ptr<PagedFile> file = file_of(tight.textures[0].pixels());
  ASSERT_TRUE(file);
  for (size_t i = 0; i < 4; ++i) {
    const TexturePixels &a = plain.textures[i].pixels(), &b = tight.textures[i].pixels();
    EXPECT_EQ(file_of(a), nullptr);
    EXPECT_EQ(file_of(b), file) << "all are in one";
    EXPECT_EQ(texel_bytes(a), texel_bytes(b));
    std::visit(
        [&]<typename T>(const std::shared_ptr<const BasicImage<T>>& image) {
          EXPECT_EQ(std::get<std::shared_ptr<const BasicImage<T>>>(in_memory(b))->values, image->values);
        },
        in_memory(a));
  }
}

TEST(TextureMemory, IsMemoryWhereThereIsRoom) {
  const SceneDescription scene = import({.bytes = uint64_t{1} << 50});
  for (const Texture& texture : scene.textures) EXPECT_EQ(file_of(texture.pixels()), nullptr);
  EXPECT_FALSE(has_notice(scene, "they are kept in a file"));
}

TEST(TextureMemory, LeavesRoomForPictures) {
  const uint64_t most = uint64_t{1} << 50;
  const SceneDescription scene = import({.bytes = most, .elsewhere = most - 1});
  EXPECT_TRUE(file_of(scene.textures[0].pixels()));
}

}  // namespace
}  // namespace vernier::test
