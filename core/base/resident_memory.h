// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vernier {

/// Gives what is free of the memory that was allocated back to the system, which keeps it low where much is
/// freed piece by piece before other things are made.
void give_back_freed_memory();

/// Bytes of memory that the process holds now, after what it has freed was given back to the system.
uint64_t resident_bytes();

}  // namespace vernier
