// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "materials/mip_pyramid.h"
#include "materials/texture_pixels.h"
#include "tests/support/random.h"

// Textures whose pixels lie in a file are read to the same bits as those in memory.

namespace vernier::test {
namespace {

template <typename T>
PixelsInMemory noise(int width, int height, int channels) {
  auto image = std::make_shared<BasicImage<T>>(width, height, channels);
  Random random{uint64_t(channels)};
  for (T& value : image->values) value = T(uint32_t(random.next1() * 65536));
  return image;
}

TexturePixels as_texture(const PixelsInMemory& pixels) { return in_file(pixels, nullptr); }

std::vector<PixelsInMemory> pictures() {
  std::vector<PixelsInMemory> all;
  for (int channels = 1; channels <= 4; ++channels) {
    all.push_back(noise<uint8_t>(301, 257, channels));
    all.push_back(noise<uint16_t>(190, 333, channels));
  }
  return all;
}

TEST(PagedTexture, IsReadAsInMemory) {
  const auto file = std::make_shared<PagedFile>(PagedFile::block_bytes);
  for (const PixelsInMemory& pixels : pictures()) {
    ASSERT_EQ(file_of(in_file(pixels, file)), file);
    for (const FilterMode filter : {FilterMode::nearest, FilterMode::linear})
      for (const WrapMode wrap : {WrapMode::repeat, WrapMode::mirrored_repeat, WrapMode::clamp_to_edge}) {
        const Texture plain(as_texture(pixels), wrap, wrap, filter);
        const Texture paged(in_file(pixels, file), wrap, wrap, filter);
        ASSERT_EQ(paged.width(), plain.width());
        ASSERT_EQ(paged.height(), plain.height());
        Random random(3);
        for (int i = 0; i < 500; ++i) {
          const Vec2f uv = random.next2() * 3.f - Vec2f(1, 1);
          for (const TexelEncoding encoding : {TexelEncoding::linear, TexelEncoding::srgb})
            ASSERT_EQ(paged.sample(uv, encoding), plain.sample(uv, encoding)) << uv.x << ", " << uv.y;
        }
      }
  }
}

TEST(PagedTexture, HasItsSmallerCopiesInTheFileToo) {
  const auto file = std::make_shared<PagedFile>(PagedFile::block_bytes);
  for (const PixelsInMemory& pixels : pictures())
    for (const bool by_alpha : {false, true}) {
      const auto pyramid_of = [&](const TexturePixels& picture) {
        const std::vector<TexturePixels> mips = make_mips(picture, by_alpha);
        EXPECT_EQ(file_of(mips[0]) != nullptr,
                  file_of(picture) && texel_bytes(mips[0]) >= PagedFile::block_bytes);
        return MipPyramid({picture, WrapMode::repeat, WrapMode::repeat, FilterMode::linear}, mips, by_alpha);
      };
      const MipPyramid plain = pyramid_of(as_texture(pixels)), paged = pyramid_of(in_file(pixels, file));
      Random random(5);
      for (int i = 0; i < 200; ++i) {
        const Vec2f uv = random.next2();
        const UvArea area{random.next2() * 0.05f, random.next2() * 0.02f};
        ASSERT_EQ(paged.sample(uv, area), plain.sample(uv, area));
      }
    }
}

TEST(PagedTexture, StaysInMemoryWhereItFillsNoBlock) {
  const auto file = std::make_shared<PagedFile>(PagedFile::block_bytes);
  EXPECT_EQ(file_of(in_file(noise<uint8_t>(100, 100, 4), file)), nullptr);
  EXPECT_EQ(file->size(), 0u);
}

}  // namespace
}  // namespace vernier::test
