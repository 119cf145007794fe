// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/ktx2/little_endian.h"

namespace vernier::ktx2 {

/// Bits of a stream from the least significant of the first byte on. Beyond its end they are zero, and the
/// reader has failed: callers test that now and then instead of at each bit.
class BitReader {
 public:
  explicit BitReader(std::span<const uint8_t> bytes) : rest_(bytes) {}

  /// The next 16 bits, which stay where they are.
  uint32_t peek() {
    if (available_ < 16) refill();
    return uint32_t(window_ & 0xffff);
  }
  /// Passes bits that were peeked at.
  void skip(int count) {
    window_ >>= count;
    available_ -= count;
  }
  /// The next 0 to 16 bits.
  uint32_t read(int count) {
    const uint32_t value = peek() & ((1u << count) - 1);
    skip(count);
    return value;
  }

  /// What was read means nothing.
  void fail() { broken_ = true; }
  bool failed() const { return broken_ || available_ < 8 * padding_; }

 private:
  void refill() {
    if (rest_.size() >= 8) {
      const int bytes = (63 - available_) / 8;
      window_ |= read_number<uint64_t>(rest_, 0) << available_;
      // Bits above the whole bytes come again with the next refill, the same as they are.
      rest_ = rest_.subspan(size_t(bytes));
      available_ += 8 * bytes;
      return;
    }
    while (available_ <= 48) {
      if (rest_.empty()) {
        ++padding_;
      } else {
        window_ |= uint64_t(rest_[0]) << available_;
        rest_ = rest_.subspan(1);
      }
      available_ += 8;
    }
  }

  std::span<const uint8_t> rest_;
  uint64_t window_ = 0;
  int available_ = 0;
  int64_t padding_ = 0;  ///< bytes of zeros appended after the end
  bool broken_ = false;
};

}  // namespace vernier::ktx2
