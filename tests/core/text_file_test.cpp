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

// Else --stats /dev/stdout, by root, would put a file in the place of the system's.
TEST(TextFile, LinksAndDevicesStayWhatTheyAre) {
  const test::TemporaryFolder folder;
  const std::string link = folder.file("link.json"), device = folder.file("device");
  std::filesystem::create_symlink(folder.write("a.json", ""), link);
  std::filesystem::create_symlink("/dev/null", device);
  for (const auto& path : {link, device}) {
    check_writable_text_file(path);
    write_text_file(path, "text\n");
    EXPECT_TRUE(std::filesystem::is_symlink(path));
  }
  EXPECT_EQ(test::read_file(folder.file("a.json")), "text\n");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.json", "device", "link.json"}));
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
