// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vernier {

/// A whole PNG file with the pixels of one that is cut off (its size has been checked); those that are
/// missing are zero. Throws Error(input) about `name` when not even the first row is there.
std::vector<uint8_t> complete_png(std::span<const uint8_t> bytes, const std::string& name);

}  // namespace vernier
