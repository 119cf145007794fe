#include "core/base/text_file.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace vernier {
namespace {

TEST(TextFile, WritesAndReplaces) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.json");
  check_writable_text_file(path);
  EXPECT_TRUE(folder.names().empty());
  write_text_file(path, "first\n");
  write_text_file(path, "second\n");
  EXPECT_EQ(test::read_file(path), "second\n");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
}

TEST(TextFile, RefusesWhatCannotBeWritten) {
  const test::TemporaryFolder folder;
  for (const std::string& path : {folder.file("missing/a.json"), folder.path().string()}) {
    for (const auto attempt : {+[](const std::string& p) { check_writable_text_file(p); },
                               +[](const std::string& p) { write_text_file(p, "x"); }}) {
      try {
        attempt(path);
        ADD_FAILURE() << path;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::output);
        EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
      }
    }
  }
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace vernier
