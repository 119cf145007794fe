// SPDX-License-Identifier: Apache-2.0
#include "core/base/quantities.h"

#include <gtest/gtest.h>

#include "vernier/error.h"

namespace vernier {
namespace {

template <typename Parse>
void expect_refused(const Parse& parse, const char* text) {
  try {
    parse(text);
    ADD_FAILURE() << "'" << text << "' was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(Quantities, SecondsWithAndWithoutUnits) {
  EXPECT_DOUBLE_EQ(parse_seconds("90s"), 90);
  EXPECT_DOUBLE_EQ(parse_seconds("10m"), 600);
  EXPECT_DOUBLE_EQ(parse_seconds("1h"), 3600);
  EXPECT_DOUBLE_EQ(parse_seconds("1.5"), 1.5);
  EXPECT_DOUBLE_EQ(parse_seconds(".5"), 0.5);
  EXPECT_DOUBLE_EQ(parse_seconds("1h30m"), 5400);
  EXPECT_DOUBLE_EQ(parse_seconds("2m3.5s"), 123.5);
}

TEST(Quantities, SecondsThatMakeNoSense) {
  for (const char* text :
       {"0", "0s", "-1", "s", "10x", "1h30", "inf", "nan", "1e400", "10 s", "1e999h", "10mm"})
    expect_refused(parse_seconds, text);
  EXPECT_THROW(parse_seconds(""), Error);
}

TEST(Quantities, AmountsOfMemory) {
  EXPECT_EQ(parse_bytes("3000000000"), 3000000000u);
  EXPECT_EQ(parse_bytes("2G"), 2000000000u);
  EXPECT_EQ(parse_bytes("1.5 GB"), 1500000000u);
  EXPECT_EQ(parse_bytes("2GiB"), uint64_t{2} << 30);
  EXPECT_EQ(parse_bytes("3Mi"), uint64_t{3} << 20);
  EXPECT_EQ(parse_bytes("12k"), 12000u);
  EXPECT_EQ(parse_bytes("1TB"), 1000000000000u);
  for (const char* text : {"0", "0.5", "-1G", "G", "2X", "2GG", "2 G B", "1e30", "inf", "2g", "2iB"})
    expect_refused(parse_bytes, text);
  EXPECT_THROW(parse_bytes(""), Error);
}

TEST(Quantities, Margins) {
  EXPECT_FLOAT_EQ(parse_margin("8%"), 0.08f);
  EXPECT_FLOAT_EQ(parse_margin("0.08"), 0.08f);
  EXPECT_EQ(parse_margin("0"), 0);
  for (const char* text : {"1", "-1%", "50%", "8%%", "x", "inf"}) expect_refused(parse_margin, text);
  EXPECT_THROW(parse_margin(""), Error);
}

TEST(Quantities, Points) {
  EXPECT_EQ(parse_point("1.5,0,-2"), (std::array<float, 3>{1.5f, 0, -2}));
  EXPECT_EQ(parse_point("-.5,1e3,0"), (std::array<float, 3>{-0.5f, 1000, 0}));
  for (const char* text : {"1,2", "1,2,3,4", "1 2 3", "1,,2", "nan,0,0", "1e40,0,0", "--1,0,0"})
    expect_refused(parse_point, text);
  EXPECT_THROW(parse_point(""), Error);
}

TEST(Quantities, Fractions) {
  EXPECT_DOUBLE_EQ(parse_fraction("1%"), 0.01);
  EXPECT_DOUBLE_EQ(parse_fraction("0.5 %"), 0.005);
  EXPECT_DOUBLE_EQ(parse_fraction("0.01"), 0.01);
  // Who forgets the sign of per cent should hear of it.
  for (const char* text : {"1", "5", "100%", "0", "-1%", "1%%", "1 percent", "nan", "%"})
    expect_refused(parse_fraction, text);
}

TEST(Quantities, Sizes) {
  const PixelSize size = parse_pixel_size("1280x720");
  EXPECT_EQ(size.width, 1280);
  EXPECT_EQ(size.height, 720);
  for (const char* text : {"0x10", "10x0", "10", "10x", "x10", "-5x5", "10x10x10", "10X10", "70000x1",
                           "1.5x2", "99999999999x1", "10x10+1+1", " 10x10"})
    expect_refused(parse_pixel_size, text);
  EXPECT_THROW(parse_pixel_size(""), Error);
}

TEST(Quantities, Rectangles) {
  const PixelRect rect = parse_pixel_rect("640x360+10+20");
  EXPECT_EQ(rect.width, 640);
  EXPECT_EQ(rect.height, 360);
  EXPECT_EQ(rect.x, 10);
  EXPECT_EQ(rect.y, 20);
  for (const char* text :
       {"640x360", "640x360+10", "640x360+10+", "640x360-1+2", "0x1+0+0", "1x1+0+0 ", "1x1+a+0"})
    expect_refused(parse_pixel_rect, text);
}

TEST(Quantities, Formatting) {
  EXPECT_EQ(format_seconds(0.0456), "46 ms");
  EXPECT_EQ(format_seconds(12.34), "12.3 s");
  EXPECT_EQ(format_seconds(59.97), "1 m 00 s");
  EXPECT_EQ(format_seconds(245), "4 m 05 s");
  EXPECT_EQ(format_seconds(7380), "2 h 03 m");
  EXPECT_EQ(format_count(950), "950");
  EXPECT_EQ(format_count(999.6), "1.00 k");
  EXPECT_EQ(format_count(12345), "12.3 k");
  EXPECT_EQ(format_count(4.56e6), "4.56 M");
  EXPECT_EQ(format_bytes(950), "950 B");
  EXPECT_EQ(format_bytes(123456789), "123 MB");
}

}  // namespace
}  // namespace vernier
