// SPDX-License-Identifier: Apache-2.0
#include "core/base/names.h"

#include <gtest/gtest.h>

#include "vernier/error.h"

namespace vernier {
namespace {

const std::vector<std::string> colours{"red", "green", "blue"};

TEST(Names, NearestByEdits) {
  EXPECT_EQ(nearest_name("red", colours), "red");
  EXPECT_EQ(nearest_name("gren", colours), "green");
  EXPECT_EQ(nearest_name("grean", colours), "green");
  EXPECT_EQ(nearest_name("bleu", colours), "blue");
  EXPECT_EQ(nearest_name("xyzzy", colours), "");
  EXPECT_EQ(nearest_name("red", {}), "");
  EXPECT_EQ(nearest_name("", std::vector<std::string>{"id"}), "");
  // A long name may differ in a third of its letters.
  EXPECT_EQ(nearest_name("whittedintegratxr", std::vector<std::string>{"whitted_integrator"}),
            "whitted_integrator");
}

TEST(Names, APrefixInAnyCaseNamesOne) {
  const std::vector<std::string> views{"ACES SDR", "standard", "stand", "neutral", "Raw", "raw"};
  EXPECT_EQ(find_by_prefix("view", "aces", views), "ACES SDR");
  EXPECT_EQ(find_by_prefix("view", "N", views), "neutral");
  EXPECT_EQ(find_by_prefix("view", "stand", views), "stand");
  EXPECT_EQ(find_by_prefix("view", "STANDARD", views), "standard");
  EXPECT_EQ(find_by_prefix("view", "raw", views), "raw");
  try {
    find_by_prefix("view", "st", views);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "view 'st' may be any of standard, stand");
  }
  for (const char* name : {"", "nuetral", "ACES SDRx"})
    EXPECT_THROW(find_by_prefix("view", name, views), Error);
}

TEST(Names, MessageSuggestsAndLists) {
  EXPECT_EQ(unknown_name_message("colour", "gren", colours),
            "unknown colour 'gren'; did you mean 'green'? There are: red, green, blue");
  EXPECT_EQ(unknown_name_message("colour", "xyzzy", colours),
            "unknown colour 'xyzzy'; there are: red, green, blue");
  EXPECT_EQ(unknown_name_message("colour", "x", {}), "unknown colour 'x'; there are: none");
}

TEST(Names, FindInTable) {
  struct Entry {
    std::string_view name;
    int value;
  };
  const std::vector<Entry> table{{"one", 1}, {"two", 2}};
  EXPECT_EQ(find_by_name(table, "number", "two").value, 2);
  try {
    find_by_name(table, "number", "tow");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_STREQ(error.what(), "unknown number 'tow'; did you mean 'two'? There are: one, two");
  }
}

}  // namespace
}  // namespace vernier
