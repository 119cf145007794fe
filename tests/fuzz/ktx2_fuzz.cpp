// SPDX-License-Identifier: Apache-2.0
// For libFuzzer: build/fuzz/tests/ktx2_fuzz CORPUS tests/core/ktx2
#include "core/ktx2/ktx2.h"
#include "vernier/error.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    vernier::ktx2::decode({data, size}, 1 << 20);
  } catch (const vernier::Error&) {
    // Damage is told by this one exception; anything else ends the program.
  }
  return 0;
}
