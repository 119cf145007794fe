// SPDX-License-Identifier: Apache-2.0
#include "vernier/error.h"

#include <gtest/gtest.h>

namespace vernier {
namespace {

TEST(ErrorText, LeavesOutWhatThereIsNot) {
  EXPECT_STREQ(Error(ErrorKind::input, "a.glb", "/accessors/3", "count is 0").what(),
               "a.glb: /accessors/3: count is 0");
  EXPECT_STREQ(Error(ErrorKind::input, "a.glb", {}, "count is 0").what(), "a.glb: count is 0");
  EXPECT_STREQ(Error(ErrorKind::usage, {}, "--size", "zero").what(), "--size: zero");
  EXPECT_STREQ(Error(ErrorKind::usage, "what?").what(), "what?");
  EXPECT_EQ(Error(ErrorKind::memory, "x").kind(), ErrorKind::memory);
}

TEST(ErrorText, IsOneLine) {
  EXPECT_STREQ(Error(ErrorKind::input, "a.png", {}, "first\nsecond\n\n").what(), "a.png: first second");
  EXPECT_STREQ(Error(ErrorKind::input, "\n").what(), "");
}

}  // namespace
}  // namespace vernier
