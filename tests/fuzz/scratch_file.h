// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace vernier::fuzz {

/// A file in a folder of its own, written anew for every input, for readers that take names of files.
class ScratchFile {
 public:
  ScratchFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "vernier-fuzz-XXXXXX").string();
    if (!mkdtemp(pattern.data())) std::abort();
    folder_ = pattern;
  }
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Its path, after it has been given this content.
  std::string write(const std::string& name, std::string_view bytes) const {
    const auto path = folder_ / name;
    if (!(std::ofstream(path, std::ios::binary) << bytes).flush()) std::abort();
    return path.string();
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace vernier::fuzz
