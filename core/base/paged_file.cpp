// SPDX-License-Identifier: Apache-2.0
#include "core/base/paged_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/mman.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "core/base/quantities.h"
#include "vernier/error.h"

namespace vernier {
namespace {

/// The Filesystem Hierarchy Standard 3.0 has /var/tmp (5.15) for what is large; /tmp is in memory on many
/// systems.
std::string folder_for_large_files() {
  const char* folder = std::getenv("TMPDIR");
  return folder && *folder ? folder : "/var/tmp";
}

/// A file without a name: nothing is left behind, however the process ends. Some file systems, such as those
/// of older containers, can only take a name away again. -1: errno says why.
int open_unnamed(const std::string& folder) {
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (unnamed >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL)) return unnamed;
  std::string name = folder + "/vernier-XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

bool is_in_memory(int descriptor) {
  struct statfs system {};
  return ::fstatfs(descriptor, &system) == 0 &&
         (system.f_type == TMPFS_MAGIC || system.f_type == RAMFS_MAGIC);
}

}  // namespace

PagedFile::PagedFile(uint64_t most_resident)
    : folder_(folder_for_large_files()),
      descriptor_(open_unnamed(folder_)),
      most_touched_(size_t(std::max<uint64_t>(most_resident / block_bytes, 1))) {
  if (descriptor_ < 0) fail("no file for textures can be made", errno);
  if (!is_in_memory(descriptor_)) return;
  ::close(descriptor_);
  throw Error(ErrorKind::output, folder_, {},
              "is held in memory, where textures would take as much as without --max-memory; set TMPDIR to a "
              "folder on a disk");
}

PagedFile::~PagedFile() {
  for (const Mapping& mapping : mappings_) ::munmap(mapping.bytes, mapping.blocks * block_bytes);
  ::close(descriptor_);
}

void PagedFile::write(std::span<const std::byte> bytes, uint64_t offset) {
  size_ += bytes.size();
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), off_t(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("textures cannot be written", written < 0 ? errno : EIO);
    bytes = bytes.subspan(size_t(written));
    offset += uint64_t(written);
  }
}

PagedFile::Part PagedFile::map(uint64_t begin, size_t blocks) {
  const size_t length = blocks * block_bytes;
  // A mapping past the end of the file could not be read, and its last block may have been cut short.
  const std::lock_guard lock(mutex_);
  if (::ftruncate(descriptor_, off_t(end_.load())) != 0) fail("textures cannot be written", errno);
  void* bytes = ::mmap(nullptr, length, PROT_READ, MAP_SHARED, descriptor_, off_t(begin));
  if (bytes == MAP_FAILED) fail("textures cannot be read back", errno);
  // Rays hit textures anywhere: reading ahead of them would read what nobody asks for.
  ::madvise(bytes, length, MADV_RANDOM);
  mappings_.push_back(
      {static_cast<std::byte*>(bytes), blocks, std::make_unique<std::atomic<uint8_t>[]>(blocks)});
  return {this, mappings_.back().bytes, mappings_.back().touched.get()};
}

void PagedFile::touch(std::atomic<uint8_t>& is_touched) {
  if (is_touched.exchange(1, std::memory_order_relaxed) != 0) return;
  if (touched_.fetch_add(1, std::memory_order_relaxed) >= most_touched_) let_go();
}

/// Threads may read meanwhile: what is not mapped any more is mapped again, unchanged. A thread that has been
/// counted and reads only afterwards holds a block more until the next time.
void PagedFile::let_go() {
  const std::lock_guard lock(mutex_);
  if (touched_.load(std::memory_order_relaxed) <= most_touched_) return;  // another thread has
  touched_.store(0, std::memory_order_relaxed);
  for (const Mapping& mapping : mappings_) {
    for (size_t block = 0; block < mapping.blocks; ++block)
      mapping.touched[block].store(0, std::memory_order_relaxed);
    ::madvise(mapping.bytes, mapping.blocks * block_bytes, MADV_DONTNEED);
  }
}

void PagedFile::fail(const char* what, int reason) const {
  const char* advice = "set TMPDIR to a folder where there is room, or raise --max-memory";
  if (reason == ENOSPC || reason == EDQUOT || reason == EFBIG)
    throw Error(
        ErrorKind::output, folder_, {},
        fmt::format("{} after {}: {}; {}", what, format_bytes(double(size_)), std::strerror(reason), advice));
  throw Error(ErrorKind::output, folder_, {}, fmt::format("{}: {}; {}", what, std::strerror(reason), advice));
}

}  // namespace vernier
