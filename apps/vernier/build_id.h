// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vernier::apps {

/// Hexadecimal number of this very build of the program, which the linker makes from all that is in it; the
/// same after stripping. Empty where the linker was told not to.
std::string build_id();

}  // namespace vernier::apps
