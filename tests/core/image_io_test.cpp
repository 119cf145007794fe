// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_io.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <limits>

#include "tests/support/file_size_limit.h"
#include "tests/support/png_bytes.h"
#include "tests/support/temporary_folder.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using test::png_bytes;
using test::PngSource;
using test::TemporaryFolder;
using testing::HasSubstr;
namespace fs = std::filesystem;

template <typename Action>
std::string error_of(ErrorKind kind, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return {};
}

Image8 decode_image8(std::span<const uint8_t> bytes, const std::string& name,
                     const ImageLimits& limits = {}) {
  return std::get<Image8>(decode_whole_image(bytes, name, limits));
}

std::string decode_error(std::span<const uint8_t> bytes) {
  return error_of(ErrorKind::input, [&] { decode_image8(bytes, "tex.png"); });
}

// Distinct values over the whole range of float, subnormals and HDR included.
Image hdr_ramp(int width, int height, int channels) {
  Image image(width, height, channels);
  for (size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = std::ldexp(1.f + float(i % 97) / 97, int(i % 250) - 130) * (i % 5 == 4 ? -1.f : 1.f);
  return image;
}

std::vector<uint8_t> file_bytes(const std::string& path) {
  const std::string text = test::read_file(path);
  return {text.begin(), text.end()};
}

TEST(ImageIo, ExrRoundTripKeepsEveryBit) {
  const TemporaryFolder folder;
  const Image image = hdr_ramp(37, 23, 3);
  write_exr(folder.file("a.exr"), image, {"R", "G", "B"}, {});
  const Image back = read_image(folder.file("a.exr"));
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 23);
  EXPECT_EQ(back.channels, 3);
  EXPECT_EQ(back.values, image.values);
}

TEST(ImageIo, HalfIsForColorAndLimitsWhatItCannotHold) {
  const TemporaryFolder folder;
  Image image(2, 1, 6);
  image.values = {1e6f, -1e6f, 1 / 3.f, 0.25f, 1e6f, 1 / 3.f, std::nanf(""), 65504, 0, 1, -3, 16777216.f};
  const std::vector<std::string> names{"R", "G", "B", "A", "depth", "error.R"};
  ExrOptions options;
  options.half = true;
  options.compression = "piz";
  write_exr(folder.file("a.exr"), image, names, {}, options);
  const LayeredImage back = read_layers(folder.file("a.exr"));
  const auto value = [&](const char* channel, int x) { return *back.single(channel)->pixel(x, 0); };
  EXPECT_EQ(value("R", 0), largest_half);
  EXPECT_EQ(value("G", 0), -largest_half);
  EXPECT_NEAR(value("B", 0), 1 / 3.f, 1 / 3.f / 2048);
  EXPECT_NE(value("B", 0), 1 / 3.f);
  EXPECT_EQ(value("A", 0), 0.25f);
  EXPECT_TRUE(std::isnan(value("R", 1)));
  EXPECT_EQ(value("depth", 0), 1e6f);
  EXPECT_EQ(value("error.R", 0), 1 / 3.f);
  EXPECT_EQ(value("error.R", 1), image.values[11]);
}

TEST(ImageIo, APartOfAPictureKeepsItsPlace) {
  const TemporaryFolder folder;
  Image part(2, 1, 3);
  part.values = {1, 2, 3, 4, 5, 6};
  ExrOptions options;
  options.place = {3, 1, 6, 4};
  write_exr(folder.file("a.exr"), part, {"R", "G", "B"}, {}, options);
  const LayeredImage back = read_layers(folder.file("a.exr"));
  EXPECT_EQ(back.image.values, part.values);
  EXPECT_EQ(back.place.x, 3);
  EXPECT_EQ(back.place.y, 1);
  EXPECT_EQ(back.place.full_width, 6);
  EXPECT_EQ(back.place.full_height, 4);
  const Image whole = read_image(folder.file("a.exr"));
  ASSERT_EQ(whole.width, 6);
  ASSERT_EQ(whole.height, 4);
  EXPECT_EQ(rgb_at(whole, 4, 1), Rgb(4, 5, 6));
  float sum = 0;
  for (const float value : whole.values) sum += value;
  EXPECT_EQ(sum, 21) << "black around it";
}

TEST(ImageIo, ExrKeepsInfinityAndNan) {
  const TemporaryFolder folder;
  Image image(2, 1, 3);
  image.values = {std::numeric_limits<float>::infinity(), 0, 1, std::nanf(""), -1, 2};
  write_exr(folder.file("a.exr"), image, {"R", "G", "B"}, {});
  const Image back = read_image(folder.file("a.exr"));
  EXPECT_EQ(back.values[0], std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(back.values[3]));
}

TEST(ImageIo, ExrHeaderHasMetadataChannelNamesAndCompression) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.exr");
  write_exr(path, hdr_ramp(4, 4, 6), {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B"},
            {{"vernier:command", "vernier render x.glb"}, {"vernier:samples", "64"}});
  const std::string bytes = test::read_file(path);
  for (const char* text : {"albedo.R", "albedo.G", "albedo.B", "vernier:command", "vernier render x.glb",
                           "vernier:samples", "chromaticities"})
    EXPECT_THAT(bytes, HasSubstr(text));
  const std::string key("compression\0compression\0\1\0\0\0", 28);
  ASSERT_THAT(bytes, HasSubstr(key));
  EXPECT_EQ(bytes[bytes.find(key) + key.size()], 3) << "ZIP_COMPRESSION is 3 in OpenEXR's file layout";
  // The beauty is found among the layers.
  EXPECT_EQ(rgb_at(read_image(path), 1, 0), rgb_at(hdr_ramp(4, 4, 6), 1, 0));
}

TEST(ImageIo, LayersComeBackByName) {
  const TemporaryFolder folder;
  const std::vector<std::string> names{"R",        "G",       "B",       "normal.X", "normal.Y",
                                       "normal.Z", "error.R", "error.G", "error.B",  "depth.Z"};
  const Image image = hdr_ramp(5, 3, 10);
  write_exr(folder.file("a.exr"), image, names, {{"vernier:seed", "7"}, {"comment", "a b"}});
  const LayeredImage back = read_layers(folder.file("a.exr"));
  EXPECT_TRUE(back.linear);
  EXPECT_THAT(back.channel_names, testing::UnorderedElementsAreArray(names));
  EXPECT_EQ(back.metadata.at("vernier:seed"), "7");
  EXPECT_EQ(back.metadata.at("comment"), "a b");
  EXPECT_FALSE(back.metadata.contains("compression"));
  const Image rgb = back.rgb(), normal = back.layer("normal").value(), error = back.layer("error").value();
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(rgb.pixel(4, 2)[c], image.pixel(4, 2)[c]);
    EXPECT_EQ(normal.pixel(4, 2)[c], image.pixel(4, 2)[3 + c]);
    EXPECT_EQ(error.pixel(4, 2)[c], image.pixel(4, 2)[6 + c]);
  }
  EXPECT_FALSE(back.layer("albedo"));
  EXPECT_FALSE(back.layer("depth"));
  // Writing what was read gives the same picture again.
  write_exr(folder.file("b.exr"), back.image, back.channel_names, back.metadata);
  EXPECT_EQ(read_layers(folder.file("b.exr")).image.values, back.image.values);
  EXPECT_EQ(read_layers(folder.file("b.exr")).metadata, back.metadata);
}

TEST(ImageIo, DisplayValuesAreToldFromLinearOnes) {
  const TemporaryFolder folder;
  write_image8(folder.file("a.png"), Image8(2, 2, 4), {});
  const LayeredImage png = read_layers(folder.file("a.png"));
  EXPECT_FALSE(png.linear);
  EXPECT_THAT(png.channel_names, testing::ElementsAre("R", "G", "B", "A"));
  // Radiance HDR: one pixel of (1, 0.5, 0.25).
  const std::string hdr =
      "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x40\x20\x81");
  const LayeredImage radiance = read_layers(folder.write("a.hdr", hdr));
  EXPECT_TRUE(radiance.linear);
  EXPECT_THAT(radiance.rgb().values, testing::Pointwise(testing::FloatNear(0.01f), {1.f, 0.5f, 0.25f}));
}

// Shrinks the data window of a file that was written with both windows equal, and its pixels with it.
TEST(ImageIo, OutsideTheDataWindowThePictureIsBlack) {
  const TemporaryFolder folder;
  write_exr(folder.file("a.exr"), hdr_ramp(2, 1, 3), {"R", "G", "B"}, {});
  std::string bytes = test::read_file(folder.file("a.exr"));
  const std::string key("displayWindow\0box2i\0\x10\0\0\0", 24);
  const size_t at = bytes.find(key);
  ASSERT_NE(at, std::string::npos);
  // The display window becomes [-1, 3] x [-1, 1] about the stored [0, 1] x [0, 0].
  bytes.replace(at + key.size(), 16, std::string("\xff\xff\xff\xff\xff\xff\xff\xff\x03\0\0\0\x01\0\0\0", 16));
  const Image picture = read_image(folder.write("b.exr", bytes));
  ASSERT_EQ(picture.width, 5);
  ASSERT_EQ(picture.height, 3);
  EXPECT_EQ(rgb_at(picture, 1, 1), rgb_at(hdr_ramp(2, 1, 3), 0, 0));
  EXPECT_EQ(rgb_at(picture, 2, 1), rgb_at(hdr_ramp(2, 1, 3), 1, 0));
  for (const auto& [x, y] : {std::pair{0, 1}, {3, 1}, {1, 0}, {1, 2}})
    EXPECT_TRUE(is_black(rgb_at(picture, x, y)));
}

TEST(ImageIo, SpecialFilesAreRefused) {
  EXPECT_THAT(error_of(ErrorKind::input, [] { read_image("/dev/zero"); }), HasSubstr("not a regular file"));
}

TEST(ImageIo, WritingTwiceGivesTheSameBytes) {
  const TemporaryFolder folder;
  for (const char* name : {"a.exr", "b.exr"})
    write_exr(folder.file(name), hdr_ramp(64, 40, 3), {"R", "G", "B"}, {});
  EXPECT_EQ(file_bytes(folder.file("a.exr")), file_bytes(folder.file("b.exr")));
}

TEST(ImageIo, PngRoundTripKeepsEveryValueAndMetadata) {
  const TemporaryFolder folder;
  for (const int channels : {1, 2, 3, 4}) {
    Image8 image(16, 16, channels);
    for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = uint8_t(i * 7 + i / 256);
    const std::string path = folder.file("a" + std::to_string(channels) + ".png");
    write_image8(path, image, {{"Software", "vernier 9.9"}, {"vernier:seed", "12"}});
    const auto bytes = file_bytes(path);
    const Image8 back = decode_image8(bytes, path);
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.values, image.values) << channels << " channels";
    const std::string text(bytes.begin(), bytes.end());
    EXPECT_THAT(text, HasSubstr("vernier 9.9"));
    EXPECT_THAT(text, HasSubstr("vernier:seed"));
  }
}

TEST(ImageIo, JpegRoundTripIsCloseAndKeepsMetadata) {
  const TemporaryFolder folder;
  Image8 image(64, 48, 3);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      image.pixel(x, y)[0] = uint8_t(4 * x);
      image.pixel(x, y)[1] = uint8_t(5 * y);
      image.pixel(x, y)[2] = 128;
    }
  write_image8(folder.file("a.JPG"), image, {{"vernier:seed", "12"}});
  const auto bytes = file_bytes(folder.file("a.JPG"));
  EXPECT_THAT(std::string(bytes.begin(), bytes.end()), HasSubstr("vernier:seed: 12"));
  const Image8 back = decode_image8(bytes, "a.JPG");
  ASSERT_EQ(back.values.size(), image.values.size());
  for (size_t i = 0; i < image.values.size(); ++i) EXPECT_NEAR(back.values[i], image.values[i], 8) << i;
}

TEST(ImageIo, SixteenBitsAreKeptWhereTheyAreMoreThanEight) {
  const auto decoded = [](std::vector<uint8_t> samples) {
    return decode_whole_image(
        png_bytes({.width = 3, .bit_depth = 16, .colour_type = 0, .samples = std::move(samples)}), "t");
  };
  EXPECT_EQ(std::get<Image16>(decoded({0xff, 0xff, 0x80, 0x80, 0x01, 0x7f})).values,
            (std::vector<uint16_t>{0xffff, 0x8080, 0x017f}));
  // Multiples of 257 are eight-bit codes.
  EXPECT_EQ(std::get<Image8>(decoded({0xff, 0xff, 0x80, 0x80, 0x01, 0x01})).values,
            (std::vector<uint8_t>{255, 128, 1}));
}

TEST(ImageIo, SixteenBitAlphaStaysUnassociated) {
  const std::vector<uint8_t> samples{0x12, 0x34, 0xff, 0xff, 0, 1, 0, 2, 0x80, 0, 0x40, 0, 0x20, 0, 0, 0};
  const auto image = std::get<Image16>(decode_whole_image(
      png_bytes({.width = 2, .bit_depth = 16, .colour_type = 6, .samples = samples}), "t"));
  EXPECT_EQ(image.values, (std::vector<uint16_t>{0x1234, 0xffff, 1, 2, 0x8000, 0x4000, 0x2000, 0}));
}

TEST(ImageIo, ACutOffPngKeepsItsSixteenBits) {
  std::vector<uint8_t> samples(2 * 3 * 64 * 64);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = uint8_t(7 * i * i + 13 * i);
  const auto bytes = png_bytes({.width = 64, .height = 64, .bit_depth = 16, .samples = samples});
  const PartialImage partial = decode_partial_image({bytes.data(), bytes.size() * 7 / 10}, "t");
  EXPECT_NE(partial.damage, "");
  const auto& image = std::get<Image16>(partial.image);
  for (size_t i = 0; i < 3 * 64; ++i) EXPECT_EQ(image.values[i], samples[2 * i] << 8 | samples[2 * i + 1]);
}

TEST(ImageIo, AlphaStaysUnassociated) {
  const std::vector<uint8_t> texel{200, 100, 50, 64, 255, 255, 255, 0};
  EXPECT_EQ(decode_image8(png_bytes({.width = 2, .colour_type = 6, .samples = texel}), "t").values, texel);
  // 4x4 lossless WebP of one colour.
  const std::vector<uint8_t> webp{'R',  'I', 'F',  'F',  0x18, 0,    0,    0,    'W',  'E',  'B',
                                  'P',  'V', 'P',  '8',  'L',  0x0c, 0,    0,    0,    0x2f, 0x03,
                                  0xc0, 0,   0x10, 0xe8, 0x6b, 0xfd, 0x8b, 0x55, 0xc0, 0};
  const Image8 image = decode_image8(webp, "t");
  EXPECT_EQ(image.width, 4);
  ASSERT_EQ(image.channels, 4);
  EXPECT_EQ(std::vector<uint8_t>(image.pixel(3, 3), image.pixel(3, 3) + 4),
            (std::vector<uint8_t>{254, 175, 88, 128}));
}

TEST(ImageIo, PaletteIsExpanded) {
  const std::vector<uint8_t> palette{255, 0, 0, 1, 2, 3};
  const Image8 image =
      decode_image8(png_bytes({.width = 2, .colour_type = 3, .samples = {1, 0}, .palette = palette}), "t");
  ASSERT_EQ(image.channels, 3);
  EXPECT_EQ(image.values, (std::vector<uint8_t>{1, 2, 3, 255, 0, 0}));
  const Image8 with_alpha = decode_image8(
      png_bytes(
          {.width = 2, .colour_type = 3, .samples = {1, 0}, .palette = palette, .palette_alpha = {7, 9}}),
      "t");
  EXPECT_EQ(with_alpha.values, (std::vector<uint8_t>{1, 2, 3, 9, 255, 0, 0, 7}));
}

TEST(ImageIo, ReadImageRepeatsGreyAndDropsAlpha) {
  const TemporaryFolder folder;
  Image8 image(1, 1, 2);
  image.values = {51, 10};
  write_image8(folder.file("g.png"), image, {});
  EXPECT_THAT(read_image(folder.file("g.png")).values,
              testing::Pointwise(testing::FloatEq(), {0.2f, 0.2f, 0.2f}));
  image = Image8(1, 1, 4);
  image.values = {51, 102, 255, 10};
  write_image8(folder.file("c.png"), image, {});
  EXPECT_THAT(read_image(folder.file("c.png")).values,
              testing::Pointwise(testing::FloatEq(), {0.2f, 0.4f, 1.f}));
}

TEST(ImageIo, EveryTruncationIsAnError) {
  const TemporaryFolder folder;
  Image8 image(40, 40, 3);
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = uint8_t(i * i);
  for (const char* name : {"a.png", "a.jpg"}) {
    write_image8(folder.file(name), image, {});
    const auto whole = file_bytes(folder.file(name));
    EXPECT_NO_THROW(decode_image8(whole, name));
    for (size_t size = 0; size < whole.size(); size += 1 + size / 16)
      EXPECT_THROW(decode_image8({whole.data(), size}, name), Error) << name << " cut to " << size;
  }
  write_exr(folder.file("a.exr"), hdr_ramp(40, 40, 3), {"R", "G", "B"}, {});
  const std::string whole = test::read_file(folder.file("a.exr"));
  for (size_t size = 0; size < whole.size(); size += 1 + size / 16) {
    const std::string cut = folder.write("cut.exr", whole.substr(0, size));
    EXPECT_THROW(read_image(cut), Error) << "cut to " << size;
  }
}

TEST(ImageIo, PartsOfOpenExrAreGroupsOfChannels) {
  const TemporaryFolder folder;
  // Blender leaves black what follows a part of a single channel without a dot; so that comes last.
  const std::vector<std::string> names{"R", "G",   "B",   "A",   "samples",
                                       "Z", "N.X", "N.Y", "N.Z", "CryptoObject00.r"};
  const Image image = hdr_ramp(5, 4, int(names.size()));
  ExrOptions options;
  options.multipart = true;
  write_exr(folder.file("a.exr"), image, names,
            {{"vernier:spp", "3"}, {"cryptomatte/1/name", "CryptoObject"}, {"cryptomatte/1/hash", "h"}},
            options);
  const auto input = OIIO::ImageInput::open(folder.file("a.exr"));
  ASSERT_TRUE(input);
  const std::vector<std::pair<std::string, int>> expected{
      {"rgba", 4}, {"Z", 1}, {"N", 3}, {"CryptoObject00", 1}, {"samples", 1}};
  for (size_t part = 0; part < expected.size(); ++part) {
    ASSERT_TRUE(input->seek_subimage(int(part), 0));
    const OIIO::ImageSpec spec = input->spec();
    EXPECT_EQ(spec.get_string_attribute("oiio:subimagename"), expected[part].first);
    EXPECT_EQ(spec.nchannels, expected[part].second);
    EXPECT_EQ(spec.get_string_attribute("vernier:spp"), part == 0 ? "3" : "");
    EXPECT_EQ(spec.get_string_attribute("cryptomatte/1/hash"), part == 0 || part == 3 ? "h" : "");
  }
  EXPECT_FALSE(input->seek_subimage(int(expected.size()), 0));
  const LayeredImage read = read_layers(folder.file("a.exr"));
  ASSERT_EQ(read.channel_names.size(), names.size());
  for (size_t c = 0; c < names.size(); ++c) {
    const auto found = std::find(read.channel_names.begin(), read.channel_names.end(), names[c]);
    ASSERT_NE(found, read.channel_names.end()) << names[c];
    EXPECT_EQ(read.image.pixel(3, 2)[found - read.channel_names.begin()], image.pixel(3, 2)[c]) << names[c];
  }
  EXPECT_EQ(encode_exr(image, names, {}, options).empty(), false);
  EXPECT_THAT(folder.names(), testing::ElementsAre("a.exr"));
}

TEST(ImageIo, DamagedBytesNeverCrash) {
  const TemporaryFolder folder;
  Image8 image(24, 24, 3);
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = uint8_t(i * 31);
  uint32_t state = 1;
  for (const char* name : {"a.png", "a.jpg"}) {
    write_image8(folder.file(name), image, {});
    const auto whole = file_bytes(folder.file(name));
    for (int trial = 0; trial < 300; ++trial) {
      auto bytes = whole;
      for (int change = 0; change < 4; ++change) {
        state = state * 1664525 + 1013904223;
        bytes[(state >> 8) % bytes.size()] = uint8_t(state >> 3);
      }
      try {
        const Image8 decoded = decode_image8(bytes, name);
        EXPECT_EQ(decoded.values.size(), size_t(decoded.width) * decoded.height * decoded.channels);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
      }
    }
  }
}

TEST(ImageIo, ImageBombsAreRefusedBeforeDecoding) {
  EXPECT_THAT(decode_error(test::png_bomb(60000, 60000)), HasSubstr("larger than the limit"));
  EXPECT_THAT(decode_error(test::png_bomb(0x7fffffff, 0x7fffffff)), HasSubstr("larger than the limit"));
  EXPECT_THAT(decode_error(test::png_bomb(16384, 16384)), HasSubstr("damaged or hostile"));
  EXPECT_THAT(decode_error(test::png_bomb(0, 16)), HasSubstr("no pixels"));
  EXPECT_THAT(
      error_of(
          ErrorKind::input,
          [] {
            decode_image8(
                png_bytes({.width = 9, .height = 9, .colour_type = 0, .samples = std::vector<uint8_t>(81)}),
                "t", {.max_pixels = 80});
          }),
      HasSubstr("limit of 80 pixels"));
}

// A progressive JPEG's coefficients are allocated when it is opened, so its size must be read by us.
TEST(ImageIo, JpegSizeIsReadBeforeOpening) {
  const std::vector<uint8_t> bytes{0xff, 0xd8, 0xff, 0xc2, 0,    11, 8,    0xff, 0xdc,
                                   0xff, 0xdc, 1,    1,    0x11, 0,  0xff, 0xd9};
  EXPECT_THAT(decode_error(bytes), HasSubstr("65500x65500"));
}

TEST(ImageIo, HostileExrHeaderIsRefused) {
  const TemporaryFolder folder;
  write_exr(folder.file("a.exr"), hdr_ramp(4, 4, 3), {"R", "G", "B"}, {});
  std::string bytes = test::read_file(folder.file("a.exr"));
  for (const std::string& window : {std::string("dataWindow"), std::string("displayWindow")}) {
    const size_t at = bytes.find(window + std::string("\0box2i\0", 7));
    ASSERT_NE(at, std::string::npos);
    const size_t x_max = at + window.size() + 7 + 4 + 8;
    std::string damaged = bytes;
    damaged.replace(x_max, 8, std::string("\xff\xff\xff\x3f\xff\xff\xff\x3f", 8));
    EXPECT_THROW(read_image(folder.write("b.exr", damaged)), Error) << window;
  }
}

TEST(ImageIo, WrongKindsOfFileAreNamed) {
  const TemporaryFolder folder;
  EXPECT_THAT(decode_error({}), HasSubstr("no bytes"));
  const std::string text = "hello there, this is a text";
  EXPECT_THAT(decode_error({reinterpret_cast<const uint8_t*>(text.data()), text.size()}),
              HasSubstr("tex.png: not a PNG, JPEG, WebP or AVIF"));
  EXPECT_THAT(error_of(ErrorKind::input, [&] { read_image(folder.file("none.exr")); }),
              HasSubstr("none.exr: cannot be read: No such file"));
  EXPECT_THAT(error_of(ErrorKind::input, [&] { read_image(folder.path().string()); }),
              HasSubstr("is a folder"));
  EXPECT_THROW(read_image(folder.write("a.exr", text)), Error);
  EXPECT_THROW(read_image(folder.write("empty.exr", "")), Error);
}

TEST(ImageIo, UnwritableOutputsAreFoundEarly) {
  const TemporaryFolder folder;
  const auto check = [](const std::string& path) {
    return error_of(ErrorKind::output, [&] { check_writable_image(path); });
  };
  EXPECT_THAT(check(folder.file("a.bmp")), HasSubstr("end the name in .exr, .png or .jpg"));
  EXPECT_THAT(check(folder.file("a")), HasSubstr(".exr"));
  EXPECT_THAT(check(folder.file("none/a.exr")), HasSubstr("does not exist"));
  folder.write("file", "");
  EXPECT_THAT(check(folder.file("file/a.exr")), HasSubstr("Not a directory"));
  fs::create_directory(folder.path() / "d.png");
  EXPECT_THAT(check(folder.file("d.png")), HasSubstr("is a folder"));
  for (const char* good : {"a.exr", "a.png", "a.jpg", "a.JPEG", "a.b.EXR"})
    EXPECT_NO_THROW(check_writable_image(folder.file(good)));
  EXPECT_THAT(folder.names(), testing::ElementsAre("d.png", "file")) << "checking creates nothing";
  if (geteuid() == 0) return;  // whom permissions do not stop
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(check(folder.file("a.exr")), HasSubstr("cannot be written: Permission denied"));
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(ImageIo, FailedWriteLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  Image8 noise(300, 300, 3);
  for (size_t i = 0; i < noise.values.size(); ++i) noise.values[i] = uint8_t(i * i * 2654435761u >> 13);
  for (const char* name : {"a.exr", "a.png", "a.jpg"}) {
    SCOPED_TRACE(name);
    const std::string path = folder.write(name, "old");
    {
      const test::FileSizeLimit limit(10000);
      const std::string problem = error_of(ErrorKind::output, [&] {
        if (std::string(name) == "a.exr")
          write_exr(path, hdr_ramp(300, 300, 3), {"R", "G", "B"}, {});
        else
          write_image8(path, noise, {});
      });
      EXPECT_EQ(problem, path + ": cannot be written: File too large");
    }
    EXPECT_TRUE(test::read_file(path) == "old");
  }
  EXPECT_THAT(folder.names(), testing::ElementsAre("a.exr", "a.jpg", "a.png"));
}

TEST(ImageIo, WritingThroughALinkReplacesItsTarget) {
  const TemporaryFolder folder;
  const std::string target = folder.write("target.exr", "old");
  fs::create_symlink(target, folder.file("link.exr"));
  write_exr(folder.file("link.exr"), hdr_ramp(2, 2, 3), {"R", "G", "B"}, {});
  EXPECT_TRUE(fs::is_symlink(folder.file("link.exr")));
  EXPECT_EQ(read_image(target).values, hdr_ramp(2, 2, 3).values);
}

TEST(ImageIo, WritingIntoAMissingFolderIsAnOutputError) {
  EXPECT_THAT(error_of(ErrorKind::output,
                       [] {
                         write_exr("/nonexistent/a.exr", hdr_ramp(2, 2, 3), {"R", "G", "B"}, {});
                       }),
              HasSubstr("/nonexistent/a.exr: cannot be written: folder '/nonexistent' does not exist"));
}

}  // namespace
}  // namespace vernier
