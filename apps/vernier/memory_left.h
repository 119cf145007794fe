// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace vernier::apps {

/// Bytes that this process may still take before the machine, its control group or a limit of the shell
/// (ulimit -v) refuses, as far as Linux tells; UINT64_MAX where it does not.
uint64_t memory_left();

/// Bytes of a scene file and of the buffers and images that it refers to. 0 where it cannot be read.
uint64_t bytes_of_scene(const std::string& file);

/// Whether there is surely room for a scene beside all that is in memory, within --max-memory (0: without).
/// Standard input is nothing to look at, and has none.
bool has_room_for_scene(const std::string& file, uint64_t max_memory);

}  // namespace vernier::apps
