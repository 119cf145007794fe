// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vernier {

/// A file that takes the place of another wholly or not at all. It is written under a name of its own in the
/// target's folder and renamed at the end; through a symbolic link, beside what the link points to. Devices
/// and pipes are written into directly. Errors name the target and the system's reason. Not for several
/// threads.
class AtomicFile {
 public:
  /// Creates the temporary file, with the permissions of the file to be replaced or, where there is none,
  /// those that the umask leaves. Throws Error(output).
  explicit AtomicFile(const std::string& path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Removes the temporary file unless commit() has returned.
  ~AtomicFile();

  /// Appends bytes. Throws Error(output).
  void write(std::span<const std::byte> bytes);
  /// Writes bytes at a place of the file, in bytes from its beginning. Returns false and keeps the reason,
  /// with which commit() throws: for libraries that may not be left by an exception.
  bool write_at(std::span<const std::byte> bytes, uint64_t offset) noexcept;
  /// Whether a write_at() has failed.
  bool has_failed() const { return failure_ != 0; }

  /// Gives the file its name after its bytes have reached the disk, so that even a loss of power leaves the
  /// old file or the new one. Throws Error(output).
  void commit();

  /// Removes what no AtomicFile has finished; may be called by a signal handler that then ends the process.
  static void remove_unfinished() noexcept;

 private:
  void open_beside();
  [[noreturn]] void fail(int reason) const;

  std::string path_;       ///< as the caller knows it
  std::string target_;     ///< behind symbolic links
  std::string temporary_;  ///< empty: written into directly
  int descriptor_ = -1;
  int failure_ = 0;  ///< errno of the first failed write_at()
  int slot_ = -1;    ///< in the list that remove_unfinished() reads
};

/// Replaces a file by an AtomicFile with this text, or these bytes one part after the other. Throws
/// Error(output).
void write_file(const std::string& path, std::string_view text);
void write_file(const std::string& path, std::span<const std::span<const std::byte>> parts);

/// Throws Error(output) unless a file can be written at `path`, which is found by creating and removing a
/// temporary one beside it; called before long work.
void check_writable(const std::string& path);

}  // namespace vernier
