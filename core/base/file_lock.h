// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vernier {

/// Says that this process writes a file, as long as it lives: no second one can say so, on this machine or on
/// another that shares the folder by a file system with locks, such as NFS. What says it is `path`.lock,
/// which the system lets go of however the process ends. Where there are no locks, nothing is refused.
class FileLock {
 public:
  /// Throws Error(output) when another process writes `path`, which it names, or when the lock's file cannot
  /// be made. Devices and pipes have no lock.
  explicit FileLock(const std::string& path);
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

 private:
  bool take(const std::string& path);

  std::string file_;
  int descriptor_ = -1;  ///< none: there are no locks here
};

}  // namespace vernier
