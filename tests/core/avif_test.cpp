// SPDX-License-Identifier: Apache-2.0
#include "tests/support/avif_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/image/image_io.h"
#include "tests/support/temporary_folder.h"
#include "vernier/error.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

std::string error_of(std::span<const uint8_t> bytes) {
  try {
    decode_partial_image(bytes, "a.avif");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return {};
}

TEST(Avif, EightBitsAreThoseOfTheFile) {
  for (const bool has_alpha : {false, true}) {
    const auto bytes = avif_fixture(has_alpha ? "rgba" : "rgb");
    const auto image = std::get<Image8>(decode_whole_image(bytes, "a.avif"));
    ASSERT_EQ(image.width, 16);
    ASSERT_EQ(image.height, 16);
    ASSERT_EQ(image.channels, has_alpha ? 4 : 3);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const uint8_t* texel = image.pixel(x, y);
        EXPECT_EQ(texel[0], 17 * x);
        EXPECT_EQ(texel[1], 17 * y);
        EXPECT_EQ(texel[2], 128);
        if (has_alpha) {
          EXPECT_EQ(texel[3], 255 - 10 * y);
        }
      }
  }
}

TEST(Avif, TenBitsAreSpreadOverSixteen) {
  const auto image = std::get<Image16>(decode_whole_image(avif_fixture("ten_bits"), "a.avif"));
  // To one code, since libavif computes in single precision.
  const auto spread = [](int ten_bits) { return int(std::lround(ten_bits * 65535 / 1023.)); };
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const uint16_t* texel = image.pixel(x, y);
      EXPECT_NEAR(texel[0], spread(4 * (16 * x + y)), 1);
      EXPECT_NEAR(texel[1], spread(4 * (16 * y + x)), 1);
      EXPECT_NEAR(texel[2], spread(255 - x), 1);
    }
}

TEST(Avif, IsReadAsFloatsFromFiles) {
  const TemporaryFolder folder;
  const auto bytes = avif_fixture("rgb");
  folder.write("a.avif", std::string(bytes.begin(), bytes.end()));
  const Image image = read_image(folder.file("a.avif"));
  EXPECT_EQ(rgb_at(image, 3, 5), Rgb(51 / 255.f, 85 / 255.f, 128 / 255.f));
}

TEST(Avif, EveryTruncationIsRefused) {
  const auto bytes = avif_fixture("rgba");
  for (size_t size = 16; size < bytes.size(); ++size)
    EXPECT_NE(error_of({bytes.data(), size}), "") << "cut to " << size;
  for (const size_t size : {size_t{40}, bytes.size() - 1})  // 40: before its size is told
    EXPECT_THAT(error_of({bytes.data(), size}), HasSubstr("avif image is truncated or damaged"));
}

TEST(Avif, DamageIsReadOrRefused) {
  for (const char* name : {"rgb", "rgba", "ten_bits"}) {
    const auto whole = avif_fixture(name);
    for (size_t at = 0; at < whole.size(); ++at)
      for (const uint8_t change : {0x01, 0x80, 0xff}) {
        auto bytes = whole;
        bytes[at] ^= change;
        error_of(bytes);
      }
  }
}

/// Overwrites the picture's size, which is beside the word.
std::vector<uint8_t> of_size(uint32_t width, uint32_t height) {
  auto bytes = avif_fixture("rgb");
  const std::string_view word = "ispe";
  auto at = std::search(bytes.begin(), bytes.end(), word.begin(), word.end()) + 8;
  for (const uint32_t value : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8) *at++ = uint8_t(value >> shift);
  return bytes;
}

TEST(Avif, SizesAreBelievedAsFarAsTheFileJustifies) {
  EXPECT_THAT(error_of(of_size(16384, 16383)), HasSubstr("claims 16384x16383 pixels but the file has only"));
  EXPECT_THAT(error_of(of_size(1u << 31, 4)), HasSubstr("has no pixels"));
  EXPECT_THAT(error_of(of_size(1 << 20, 1 << 20)), HasSubstr("larger than the limit"));
  EXPECT_THAT(error_of(of_size(8, 16)), HasSubstr("cannot decode avif image")) << "smaller than the picture";
}

}  // namespace
}  // namespace vernier::test
