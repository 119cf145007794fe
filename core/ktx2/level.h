// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/ktx2/container.h"

namespace vernier::ktx2 {

/// The base level's bytes where it has a size that follows from the picture's.
class Level {
 public:
  /// Throws Error(input) when there are not `size` bytes.
  Level(const Container& container, size_t size);

  std::span<const uint8_t> bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> decompressed_;
  std::span<const uint8_t> bytes_;
};

}  // namespace vernier::ktx2
