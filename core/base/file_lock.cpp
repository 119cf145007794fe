// SPDX-License-Identifier: Apache-2.0
#include "core/base/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>

#include "vernier/error.h"

namespace vernier {
namespace {

constexpr mode_t permissions = 0666;  // less what the umask takes

/// "process 123 on node7"
std::string this_process() {
  std::array<char, HOST_NAME_MAX + 1> host{};
  ::gethostname(host.data(), host.size() - 1);
  return fmt::format("process {} on {}", ::getpid(), host.data());
}

/// What the process that has the lock wrote into its file.
std::string read_holder(int descriptor) {
  std::array<char, 256> text{};
  const ssize_t length = ::pread(descriptor, text.data(), text.size(), 0);
  return length > 0 ? std::string(text.data(), size_t(length)) : "another process";
}

/// Whether a descriptor is of the file that has this name now.
bool is_named(int descriptor, const std::string& file) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace

FileLock::FileLock(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_other(path, error)) return;
  file_ = path + ".lock";
  while (!take(path)) {
  }
}

/// False when another process removed the file, as it ended, between opening and locking.
bool FileLock::take(const std::string& path) {
  descriptor_ = ::open(file_.c_str(), O_CREAT | O_RDWR | O_NOFOLLOW | O_CLOEXEC, permissions);
  if (descriptor_ < 0)
    throw Error(ErrorKind::output, file_, {}, fmt::format("cannot be written: {}", std::strerror(errno)));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    const std::string holder = read_holder(descriptor_);
    if (reason != EWOULDBLOCK) ::unlink(file_.c_str());
    ::close(descriptor_);
    descriptor_ = -1;
    if (reason == EWOULDBLOCK)
      throw Error(ErrorKind::output, path, {},
                  fmt::format("is being written by {}, and one of the two would lose its work; wait for it, "
                              "or name another file",
                              holder));
    return true;
  }
  if (!is_named(descriptor_, file_)) {
    ::close(descriptor_);
    descriptor_ = -1;
    return false;
  }
  const std::string holder = this_process();
  // For people only: where it cannot be written, on a full disk, they are told less.
  [[maybe_unused]] const bool is_told =
      ::ftruncate(descriptor_, 0) == 0 && ::pwrite(descriptor_, holder.data(), holder.size(), 0) > 0;
  return true;
}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace vernier
