// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <webp/encode.h>

#include "core/image/image_io.h"
#include "tests/support/temporary_folder.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using testing::HasSubstr;

/// Rows that differ and do not compress to nothing.
Image8 pattern() {
  Image8 image(64, 64, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = uint8_t(7 * x * x + 13 * y * y + 5 * x * y + 40 * c);
  return image;
}

std::vector<uint8_t> file_bytes(const char* name) {
  const test::TemporaryFolder folder;
  write_image8(folder.file(name), pattern(), {});
  const std::string text = test::read_file(folder.file(name));
  return {text.begin(), text.end()};
}

std::vector<uint8_t> webp_bytes() {
  const Image8 image = pattern();
  uint8_t* bytes = nullptr;
  const size_t size = WebPEncodeLosslessRGB(image.values.data(), 64, 64, 64 * 3, &bytes);
  std::vector<uint8_t> result(bytes, bytes + size);
  WebPFree(bytes);
  return result;
}

const Image8& image8(const PartialImage& partial) { return std::get<Image8>(partial.image); }
Image8 whole8(std::span<const uint8_t> bytes, const std::string& name) {
  return std::get<Image8>(decode_whole_image(bytes, name));
}

/// The largest difference between two pictures in a row.
int difference(const Image8& a, const Image8& b, int row) {
  int largest = 0;
  for (int i = 0; i < a.width * a.channels; ++i)
    largest = std::max(largest, std::abs(int(a.pixel(0, row)[i]) - int(b.pixel(0, row)[i])));
  return largest;
}

TEST(PartialImage, OfAWholeFileIsTheWhole) {
  for (const char* name : {"a.png", "a.jpg"}) {
    const auto bytes = file_bytes(name);
    const PartialImage partial = decode_partial_image(bytes, "t");
    EXPECT_EQ(partial.damage, "");
    EXPECT_EQ(image8(partial).values, whole8(bytes, "t").values);
  }
  EXPECT_EQ(std::get<Image8>(decode_partial_image(webp_bytes(), "t").image).values, pattern().values);
}

TEST(PartialImage, NeedsNoEndMark) {
  for (const auto& [name, mark] : {std::pair("a.png", 12), std::pair("a.jpg", 2)}) {
    const auto bytes = file_bytes(name);
    const Image8 whole = whole8(bytes, "t");
    for (int cut = 1; cut <= mark; ++cut) {
      const PartialImage partial = decode_partial_image({bytes.data(), bytes.size() - size_t(cut)}, "t");
      EXPECT_THAT(partial.damage, HasSubstr("truncated"));
      EXPECT_EQ(image8(partial).values, whole.values) << name << " without its last " << cut << " bytes";
    }
  }
}

TEST(PartialImage, ShowsTheRowsThatAreThere) {
  for (const char* name : {"a.png", "a.jpg"}) {
    const auto bytes = file_bytes(name);
    const Image8 whole = whole8(bytes, "t");
    const PartialImage partial = decode_partial_image({bytes.data(), bytes.size() * 7 / 10}, "t");
    EXPECT_THAT(partial.damage, HasSubstr("truncated"));
    EXPECT_EQ(difference(image8(partial), whole, 0), 0) << name;
    EXPECT_EQ(difference(image8(partial), whole, 7), 0) << name;
    EXPECT_GT(difference(image8(partial), whole, 63), 20) << name;
  }
}

TEST(PartialImage, WithoutAnyRowIsAnError) {
  for (const char* name : {"a.png", "a.jpg"}) {
    const auto bytes = file_bytes(name);
    for (const size_t size : {size_t{4}, size_t{20}, size_t{33}, size_t{45}})
      EXPECT_THROW(decode_partial_image({bytes.data(), size}, "t"), Error) << name << " cut to " << size;
  }
}

TEST(PartialImage, EveryTruncationIsReadOrRefused) {
  for (const auto& bytes : {file_bytes("a.png"), file_bytes("a.jpg"), webp_bytes()})
    for (size_t size = 0; size < bytes.size(); ++size) try {
        EXPECT_NE(decode_partial_image({bytes.data(), size}, "t").damage, "");
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
      }
}

TEST(PartialImage, WrongChecksumsAreDamageAndNoTruncation) {
  auto bytes = file_bytes("a.png");
  bytes[bytes.size() - 20] ^= 1;
  EXPECT_THROW(decode_partial_image(bytes, "t"), Error);
}

}  // namespace
}  // namespace vernier
