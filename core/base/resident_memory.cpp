// SPDX-License-Identifier: Apache-2.0
#include "core/base/resident_memory.h"

#include <malloc.h>
#include <unistd.h>

#include <fstream>

namespace vernier {

void give_back_freed_memory() { malloc_trim(0); }

uint64_t resident_bytes() {
  give_back_freed_memory();
  std::ifstream stream("/proc/self/statm");
  uint64_t all = 0, resident = 0;
  stream >> all >> resident;
  return resident * uint64_t(sysconf(_SC_PAGESIZE));
}

}  // namespace vernier
