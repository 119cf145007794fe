// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vernier {

/// Bytes of memory that the process holds now, after what it has freed was given back to the system.
uint64_t resident_bytes();

}  // namespace vernier
