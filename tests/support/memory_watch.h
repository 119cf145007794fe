// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace vernier::test {

/// Largest number of bytes allocated at once by the program since the watch was made, above those allocated
/// then: to within the megabyte that allocations have to have to be noticed. Only sanitizers tell; 0 without.
/// One at a time.
class MemoryWatch {
 public:
  MemoryWatch();
  size_t most() const;

 private:
  size_t before_;
};

}  // namespace vernier::test
