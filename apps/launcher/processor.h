// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace vernier::launcher {

/// What a program is built for: a level of x86-64 as compilers name it for -march= (System V ABI, AMD64
/// supplement, table 3.1), or "native" for a processor that the one who built it chose, which cannot be
/// checked.
struct Level {
  const char* name;
  bool (*supported)();  ///< by this processor and system
};

/// Every level, the best first.
std::span<const Level> levels();

/// Whether a program of the level with this name can run here.
bool is_supported(std::string_view name);

/// Name of the best level that is supported.
const char* best_level();

}  // namespace vernier::launcher
