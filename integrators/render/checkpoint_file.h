// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

// How the file of a checkpoint begins: preamble and header. docs/resume.md describes its format.

namespace vernier {

struct CheckpointPreamble {
  static constexpr uint32_t current_format = 6;

  std::array<char, 8> magic{'V', 'E', 'R', 'N', 'C', 'K', 'P', 'T'};
  uint32_t format = current_format;
  uint32_t header_length = 0;
  std::array<char, 32> header_fingerprint{};  ///< hexadecimal, of the header
};
static_assert(sizeof(CheckpointPreamble) == 48);

/// Reads a file from its beginning to its end.
class CheckpointReader {
 public:
  /// Throws Error(input) when it cannot be opened.
  explicit CheckpointReader(const std::string& path);

  uintmax_t left() const { return left_; }
  void read(std::span<std::byte> bytes);
  [[noreturn]] void damaged(const std::string& how) const;
  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  uintmax_t left_ = 0;
};

/// The header, of which the fingerprint is right; what it says is still to be checked.
nlohmann::ordered_json read_checkpoint_header(CheckpointReader& reader);

}  // namespace vernier
