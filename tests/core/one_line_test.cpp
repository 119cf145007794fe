// SPDX-License-Identifier: Apache-2.0
#include "core/base/one_line.h"

#include <gtest/gtest.h>

#include "vernier/error.h"

namespace vernier {
namespace {

TEST(OneLine, LeavesTextOfAnyLanguageAlone) {
  for (const char* text :
       {"", "a.glb: /nodes/3", "Bl\xC3\xBCte \xE6\xA4\x85 \xF0\x9F\xAA\x91", "\xEF\xBF\xBD"})
    EXPECT_EQ(one_line(text), text);
}

TEST(OneLine, TurnsControlCharactersIntoSpaces) {
  EXPECT_EQ(one_line("a\nb\r\nc\td\x7f"
                     "e"),
            "a b  c d e");
  EXPECT_EQ(one_line(std::string_view("a\0b", 3)), "a b");
  EXPECT_EQ(one_line("\x1b[31mred\x1b[0m"), " [31mred [0m");
  EXPECT_EQ(one_line("a\xC2\x9B"
                     "31m"),
            "a 31m")
      << "the control sequence introducer of Latin-1";
  EXPECT_EQ(one_line("a\xE2\x80\xA8"
                     "b\xE2\x80\xAE"
                     "c\xE2\x81\xA6"
                     "d"),
            "a b c d");
  EXPECT_EQ(one_line("end\n\n "), "end");
}

TEST(OneLine, ReplacesWhatIsNotUtf8ByteByByte) {
  const std::string mark = "\xEF\xBF\xBD";
  EXPECT_EQ(one_line("a\xff"
                     "b"),
            "a" + mark + "b");
  EXPECT_EQ(one_line("a\xC3"
                     "b"),
            "a" + mark + "b")
      << "the byte after a bad one may be good";
  EXPECT_EQ(one_line("\xC0\xAF"), mark + mark) << "overlong";
  EXPECT_EQ(one_line("\xED\xA0\x80"), mark + mark + mark) << "a surrogate";
  EXPECT_EQ(one_line("cut\xE6\xA4"), "cut" + mark + mark);
  for (int byte = 0; byte < 256; ++byte)
    for (const char* before : {"", "\xE6", "\xF0\x9F"}) {
      const std::string line = one_line(before + std::string(1, char(byte)) + "x");
      EXPECT_EQ(one_line(line), line);
    }
}

TEST(OneLine, IsWhatErrorsSay) {
  EXPECT_STREQ(Error(ErrorKind::input, "a\xff.glb", "/x\n", "is \x1b[2J").what(),
               "a\xEF\xBF\xBD.glb: /x : is  [2J");
}

}  // namespace
}  // namespace vernier
