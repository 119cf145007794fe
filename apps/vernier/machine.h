// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace vernier::apps {

/// The processor's own name for itself; "unknown" where the system does not tell.
std::string cpu_name();

/// Largest resident size of this process so far.
uint64_t peak_memory_bytes();

/// Processor time used by this process so far, all threads.
double cpu_seconds();

/// Names and versions of what this program was built with.
nlohmann::ordered_json build_versions();

}  // namespace vernier::apps
