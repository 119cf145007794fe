// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace vernier {

/// Bytes that are kept on a disk and read like memory: a file without a name, in the folder that TMPDIR says
/// or else in /var/tmp, that goes when the last of its readers does, or with the process. The kernel reads
/// what is looked at, keeps it as long as it has nothing better to do with the memory, and can always take it
/// back. What the process itself holds of it is bounded here: blocks are counted when they are first touched,
/// and once there are too many, all are let go; those still in the kernel's cache come back without a read.
class PagedFile {
 public:
  /// What is counted: what the kernel maps at once of a file that it has in its cache (fault_around_bytes).
  static constexpr size_t block_bytes = 65536;

  /// Keeps at most this much of it in the process at a time, a block a thread more. Throws Error(output)
  /// where there can be no such file, or none on a disk.
  explicit PagedFile(uint64_t most_resident);
  ~PagedFile();
  PagedFile(const PagedFile&) = delete;
  PagedFile& operator=(const PagedFile&) = delete;

  /// Some blocks of the file, one after the other.
  class Part {
   public:
    /// Where a byte of it is, to be read at once, up to the end of its block; from many threads. What lies
    /// there never changes, but is counted only when it was asked for.
    const std::byte* at(size_t offset) const {
      std::atomic<uint8_t>& is_touched = touched_[offset / block_bytes];
      if (is_touched.load(std::memory_order_relaxed) == 0) [[unlikely]]
        file_->touch(is_touched);
      return bytes_ + offset;
    }

   private:
    friend class PagedFile;
    Part(PagedFile* file, const std::byte* bytes, std::atomic<uint8_t>* touched)
        : file_(file), bytes_(bytes), touched_(touched) {}

    PagedFile* file_;
    const std::byte* bytes_;
    std::atomic<uint8_t>* touched_;
  };

  /// A part of this many blocks; `fill(block, bytes)` writes one of them and returns how many of its bytes
  /// there are. From many threads, also while others are read. Throws Error(output), when the disk is full
  /// for instance.
  template <typename Fill>
  Part add(size_t blocks, const Fill& fill) {
    const uint64_t begin = reserve(blocks);
    std::vector<std::byte> bytes(block_bytes);
    for (size_t block = 0; block < blocks; ++block)
      write({bytes.data(), fill(block, std::span<std::byte>(bytes))}, begin + block * block_bytes);
    return map(begin, blocks);
  }

  const std::string& folder() const { return folder_; }
  /// Bytes written.
  uint64_t size() const { return size_; }

 private:
  struct Mapping {
    std::byte* bytes;
    size_t blocks;
    std::unique_ptr<std::atomic<uint8_t>[]> touched;
  };

  uint64_t reserve(size_t blocks) { return end_.fetch_add(blocks * block_bytes); }
  void write(std::span<const std::byte> bytes, uint64_t offset);
  Part map(uint64_t begin, size_t blocks);
  void touch(std::atomic<uint8_t>& is_touched);
  void let_go();
  [[noreturn]] void fail(const char* what, int reason) const;

  std::string folder_;
  int descriptor_ = -1;
  size_t most_touched_;  ///< blocks
  std::atomic<size_t> touched_ = 0;
  std::atomic<uint64_t> end_ = 0, size_ = 0;
  std::mutex mutex_;  ///< of what follows
  std::vector<Mapping> mappings_;
};

}  // namespace vernier
