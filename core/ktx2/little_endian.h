// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

namespace vernier::ktx2 {

static_assert(std::endian::native == std::endian::little, "files are little-endian and read as they stand");

/// The unsigned number at `at`, which must lie inside with all its bytes.
template <typename T>
T read_number(std::span<const uint8_t> bytes, size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

}  // namespace vernier::ktx2
