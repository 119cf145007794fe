// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace vernier {

/// 128-bit fingerprint as 32 hexadecimal digits; the same on every machine, not meant against forgery.
std::string fingerprint(std::span<const std::byte> bytes);

inline std::string fingerprint(std::span<const uint8_t> bytes) { return fingerprint(std::as_bytes(bytes)); }

}  // namespace vernier
