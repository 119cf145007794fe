// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vernier {

/// Hexadecimal number of this very build of the program, or of libvernier where that is shared, which the
/// linker makes from all that is in it; the same after stripping. Empty where the linker was told not to.
std::string build_id();

/// What the last bits of results depend on beside the program itself: the C library chooses its sines and
/// exponentials by the processor's features. "avx2 avx512f fma, glibc 2.36, GNU 12.2.0".
std::string platform();

}  // namespace vernier
