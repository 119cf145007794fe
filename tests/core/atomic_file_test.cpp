// SPDX-License-Identifier: Apache-2.0
#include "core/base/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <csignal>

#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"
#include "vernier/error.h"

namespace vernier {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

/// What is said when `action` fails; one line.
template <typename Action>
std::string output_error(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::output);
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
    EXPECT_THAT(error.what(), Not(HasSubstr(".vernier"))) << "temporary names are nobody's business";
    return error.what();
  }
  return "no error";
}

TEST(AtomicFileTest, WritesAndReplaces) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.json");
  check_writable(path);
  EXPECT_TRUE(folder.names().empty());
  write_file(path, "first\n");
  write_file(path, "second\n");
  EXPECT_EQ(test::read_file(path), "second\n");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
}

TEST(AtomicFileTest, TheOldFileStaysUntilTheNewOneIsComplete) {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("a.json", "old");
  {
    AtomicFile file(path);
    file.write(bytes_of("new, but not all of it"));
    EXPECT_EQ(folder.names().size(), 2u);
    EXPECT_EQ(test::read_file(path), "old");
  }
  EXPECT_EQ(test::read_file(path), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
  AtomicFile file(path);
  EXPECT_TRUE(file.write_at(bytes_of("56"), 5));
  EXPECT_TRUE(file.write_at(bytes_of("01234"), 0));
  EXPECT_EQ(test::read_file(path), "old");
  file.commit();
  EXPECT_EQ(test::read_file(path), "0123456");
}

TEST(AtomicFileTest, TwoAtOnceDoNotMeet) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.json");
  AtomicFile first(path), second(path);
  first.write(bytes_of("first"));
  second.write(bytes_of("second"));
  second.commit();
  EXPECT_EQ(test::read_file(path), "second");
  first.commit();
  EXPECT_EQ(test::read_file(path), "first");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
}

// Else --stats /dev/stdout, by root, would put a file in the place of the system's.
TEST(AtomicFileTest, LinksAndDevicesStayWhatTheyAre) {
  const test::TemporaryFolder folder;
  const std::string link = folder.file("link.json"), chain = folder.file("chain"),
                    device = folder.file("device"), dangling = folder.file("dangling");
  fs::create_symlink("a.json", link);
  fs::create_symlink(link, chain);
  fs::create_symlink("/dev/null", device);
  fs::create_directory(folder.path() / "deep");
  fs::create_symlink("deep/b.json", dangling);
  folder.write("a.json", "");
  for (const auto& path : {link, chain, device, dangling}) {
    check_writable(path);
    write_file(path, "text of " + path);
    EXPECT_TRUE(fs::is_symlink(path));
  }
  EXPECT_EQ(test::read_file(folder.file("a.json")), "text of " + chain);
  EXPECT_EQ(test::read_file(folder.file("deep/b.json")), "text of " + dangling);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(folder.names(),
            (std::vector<std::string>{"a.json", "chain", "dangling", "deep", "device", "link.json"}));
}

TEST(AtomicFileTest, PermissionsAreThoseOfTheOldFileOrTheUmask) {
  const test::TemporaryFolder folder;
  const std::string old_file = folder.write("old", ""), new_file = folder.file("new");
  const auto mode = [](const std::string& path) {
    struct stat found {};
    EXPECT_EQ(stat(path.c_str(), &found), 0);
    return found.st_mode & 07777;
  };
  const mode_t umask_before = umask(027);
  for (const mode_t wanted : {0600, 0664, 0755, 04644}) {
    chmod(old_file.c_str(), wanted);
    write_file(old_file, "text");
    EXPECT_EQ(mode(old_file), wanted & 0777) << "a set-user-ID bit does not pass to other content";
  }
  write_file(new_file, "text");
  EXPECT_EQ(mode(new_file), 0640u);
  umask(umask_before);
}

TEST(AtomicFileTest, RefusesWhatCannotBeWritten) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("file", "");
  fs::create_symlink("loop", folder.file("loop"));
  const std::vector<std::pair<std::string, std::string>> cases{
      {folder.file("missing/a.json"),
       "folder '" + folder.file("missing") + "' does not exist; create it first"},
      {folder.path().string(), "is a folder; name a file in it"},
      {folder.file("file/a.json"), "cannot be written: Not a directory"},
      {"/proc/a.json", "cannot be written: "},  // where even root may create nothing
      {folder.file("loop"), "cannot be written: "},
      {folder.file(std::string(300, 'a')), "cannot be written: File name too long"},
      {"", "cannot be written: "}};
  for (const auto& [path, reason] : cases)
    for (const auto attempt : {+[](const std::string& p) { check_writable(p); },
                               +[](const std::string& p) { write_file(p, "x"); }})
      EXPECT_THAT(output_error([&, p = path] { attempt(p); }),
                  testing::AllOf(HasSubstr(path), HasSubstr(reason)));
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"file", "loop"}));
  if (geteuid() == 0) return;  // whom permissions do not stop
  chmod(file.c_str(), 0444);
  EXPECT_THAT(output_error([&] { check_writable(file); }), HasSubstr("cannot be written: Permission denied"));
  chmod(folder.path().c_str(), 0555);
  EXPECT_THAT(output_error([&] { check_writable(folder.file("b")); }), HasSubstr("Permission denied"));
  chmod(folder.path().c_str(), 0755);
}

TEST(AtomicFileTest, AFullDiskLeavesTheOldFileAndSaysWhy) {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("a.json", "old");
  const std::string text(100000, 'x');
  {
    const test::FileSizeLimit limit(10000);
    EXPECT_EQ(output_error([&] { write_file(path, text); }), path + ": cannot be written: File too large");
    AtomicFile file(path);
    EXPECT_FALSE(file.write_at(bytes_of(text), 0));
    EXPECT_FALSE(file.write_at(bytes_of("x"), 0)) << "and stays so";
    EXPECT_TRUE(file.has_failed());
    EXPECT_EQ(output_error([&] { file.commit(); }), path + ": cannot be written: File too large");
  }
  EXPECT_EQ(output_error([] { write_file("/dev/full", "text"); }),
            "/dev/full: cannot be written: No space left on device");
  EXPECT_EQ(test::read_file(path), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
}

TEST(AtomicFileTest, ASignalHandlerCanRemoveWhatIsNotFinished) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.json");
  const auto die_in_the_midst = [&] {
    std::signal(SIGTERM, [](int signal) {
      AtomicFile::remove_unfinished();
      std::signal(signal, SIG_DFL);
      std::raise(signal);
    });
    write_file(path, "finished");
    std::vector<std::unique_ptr<AtomicFile>> files;
    for (int i = 0; i < 5; ++i) files.push_back(std::make_unique<AtomicFile>(path));
    files.erase(files.begin() + 1);
    files.push_back(std::make_unique<AtomicFile>(path));
    std::raise(SIGTERM);
  };
  EXPECT_EXIT(die_in_the_midst(), testing::KilledBySignal(SIGTERM), "");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
  EXPECT_EQ(test::read_file(path), "finished");
}

}  // namespace
}  // namespace vernier
