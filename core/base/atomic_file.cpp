// SPDX-License-Identifier: Apache-2.0
#include "core/base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>

#include "vernier/error.h"

namespace vernier {
namespace {

namespace fs = std::filesystem;

/// Temporary files that exist now. A signal handler may touch nothing but lock-free atomics and memory that
/// is never freed; a slot whose state it has taken is not used again.
class UnfinishedFiles {
 public:
  /// The slot, or -1 where there is none left: the file then stays behind when a signal ends the process.
  int add(const std::string& file) {
    if (file.size() >= PATH_MAX) return -1;
    for (size_t i = 0; i < slots_.size(); ++i) {
      State expected = State::free;
      if (!slots_[i].state.compare_exchange_strong(expected, State::filling)) continue;
      file.copy(slots_[i].name.data(), file.size());
      slots_[i].name[file.size()] = 0;
      slots_[i].state = State::exists;
      return int(i);
    }
    return -1;
  }
  void forget(int slot) {
    State expected = State::exists;
    if (slot >= 0) slots_[size_t(slot)].state.compare_exchange_strong(expected, State::free);
  }
  void remove_all() noexcept {
    for (Slot& slot : slots_)
      if (slot.state.exchange(State::removed) == State::exists) ::unlink(slot.name.data());
  }

 private:
  enum class State { free, filling, exists, removed };
  struct Slot {
    std::atomic<State> state = State::free;
    std::array<char, PATH_MAX> name{};
  };
  static_assert(std::atomic<State>::is_always_lock_free, "a signal handler reads it");

  std::array<Slot, 16> slots_;
};

UnfinishedFiles unfinished;

/// Devices and pipes, such as /dev/stdout, are written into and never replaced.
bool is_special(const std::string& path) {
  std::error_code error;
  return fs::is_other(path, error);
}

/// What a chain of symbolic links ends at, which need not exist.
std::string behind_links(const std::string& path) {
  constexpr int longest_chain = 40;  // as Linux follows
  fs::path target(path);
  std::error_code error;
  for (int i = 0; i < longest_chain && fs::is_symlink(target, error); ++i) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) break;
    target = target.parent_path() / next;  // an absolute `next` replaces the folder
  }
  return target.string();
}

fs::path folder_of(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

/// Nobody can have put a link or file there beforehand.
std::string unpredictable_name() {
  std::array<uint64_t, 2> bits{};
  if (::getrandom(bits.data(), sizeof(bits), 0) != ssize_t(sizeof(bits)))
    throw Error(ErrorKind::output, fmt::format("the system gives no random bytes: {}", std::strerror(errno)));
  return fmt::format(".vernier-{:016x}{:016x}.tmp", bits[0], bits[1]);
}

/// Writes everything at `offset`, or appends where that is negative; returns 0 or errno.
int write_fully(int descriptor, std::span<const std::byte> bytes, int64_t offset) {
  while (!bytes.empty()) {
    const ssize_t count = offset < 0 ? ::write(descriptor, bytes.data(), bytes.size())
                                     : ::pwrite(descriptor, bytes.data(), bytes.size(), offset);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes = bytes.subspan(size_t(count));
    if (offset >= 0) offset += count;
  }
  return 0;
}

/// A new file with the permissions of the one that it replaces and, as far as the user may, its owner.
int create_like(const std::string& old_file, const std::string& new_file) {
  constexpr mode_t permissions = S_IRWXU | S_IRWXG | S_IRWXO;
  struct stat old {};
  const bool replaces = ::stat(old_file.c_str(), &old) == 0;
  // Never more than these, not even while the file is empty.
  const mode_t mode = replaces ? old.st_mode & permissions : 0666;
  const int descriptor = ::open(new_file.c_str(), O_CREAT | O_EXCL | O_NOFOLLOW | O_WRONLY | O_CLOEXEC, mode);
  if (descriptor < 0 || !replaces) return descriptor;
  const bool same_group =
      ::fchown(descriptor, old.st_uid, old.st_gid) == 0 || ::fchown(descriptor, uid_t(-1), old.st_gid) == 0;
  // What the group may do is not for another group; and the umask has no say in a file that was there.
  ::fchmod(descriptor, same_group ? mode : mode & ~mode_t(S_IRWXG));
  return descriptor;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
  std::error_code error;
  if (fs::is_directory(path, error))
    throw Error(ErrorKind::output, path, {}, "is a folder; name a file in it");
  if (is_special(path)) {
    target_ = path;
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  target_ = behind_links(path);
  struct stat old {};
  const bool replaces = ::lstat(target_.c_str(), &old) == 0;
  if (!replaces && (errno != ENOENT || path.empty())) fail(errno);  // a name that is too long, among others
  if (replaces && S_ISLNK(old.st_mode)) fail(ELOOP);
  if (replaces && ::access(target_.c_str(), W_OK) != 0) fail(errno);
  open_beside();
}

void AtomicFile::open_beside() {
  const fs::path folder = folder_of(target_);
  std::error_code error;
  if (!fs::exists(folder, error) && error.value() != EACCES)
    throw Error(
        ErrorKind::output, path_, {},
        fmt::format("cannot be written: folder '{}' does not exist; create it first", folder.string()));
  const std::string name = (folder / unpredictable_name()).string();
  descriptor_ = create_like(target_, name);
  if (descriptor_ < 0) fail(errno);
  temporary_ = name;
  slot_ = unfinished.add(temporary_);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  unfinished.forget(slot_);
}

void AtomicFile::fail(int reason) const {
  throw Error(ErrorKind::output, path_, {}, fmt::format("cannot be written: {}", std::strerror(reason)));
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  if (const int reason = write_fully(descriptor_, bytes, -1)) fail(reason);
}

bool AtomicFile::write_at(std::span<const std::byte> bytes, uint64_t offset) noexcept {
  if (failure_ == 0) failure_ = write_fully(descriptor_, bytes, int64_t(offset));
  return failure_ == 0;
}

void AtomicFile::commit() {
  if (failure_ != 0) fail(failure_);
  // Some file systems have nothing to bring to a disk and say so by EINVAL.
  if (!temporary_.empty() && ::fdatasync(descriptor_) != 0 && errno != EINVAL) fail(errno);
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0) fail(errno);
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  temporary_.clear();
}

void AtomicFile::remove_unfinished() noexcept { unfinished.remove_all(); }

void write_file(const std::string& path, std::string_view text) {
  const std::array parts{std::as_bytes(std::span(text))};
  write_file(path, parts);
}

void write_file(const std::string& path, std::span<const std::span<const std::byte>> parts) {
  AtomicFile file(path);
  for (const auto& part : parts) file.write(part);
  file.commit();
}

void check_writable(const std::string& path) {
  if (!is_special(path)) {
    const AtomicFile file(path);
  } else if (::access(path.c_str(), W_OK) != 0) {  // a pipe would wait for its reader when it is opened
    throw Error(ErrorKind::output, path, {}, fmt::format("cannot be written: {}", std::strerror(errno)));
  }
}

}  // namespace vernier
