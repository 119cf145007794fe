// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>

// How hard the long statistical tests try. The sanitized build looks for bad memory accesses and undefined
// behaviour, which show in any sample, and runs many times slower: there those tests draw fewer samples and
// ask for a coarser agreement, as much as that many samples resolve.

namespace vernier::test {

#ifdef VERNIER_SANITIZED
constexpr int thinning = 16;
constexpr double coarsening = 4;
#else
/// Divides the number of samples of the longest tests.
constexpr int thinning = 1;
/// Multiplies the smallest error they find: the square root of the thinning.
constexpr double coarsening = 1;
#endif

/// The number in the environment variable, which asks for more than tests usually do; without it, `usual`.
inline uint64_t asked_or(const char* variable, uint64_t usual) {
  const char* asked = std::getenv(variable);
  return asked ? std::strtoull(asked, nullptr, 10) : usual;
}

/// Seeds [first, first + count) of the damaged files that a test makes: VERNIER_MUTANTS=N makes N of each
/// kind in place of the usual few, VERNIER_FIRST_MUTANT=K begins with the K-th: another run makes others.
struct MutantSeeds {
  explicit MutantSeeds(uint64_t usual)
      : first(asked_or("VERNIER_FIRST_MUTANT", 0)), count(asked_or("VERNIER_MUTANTS", usual)) {}

  uint64_t end() const { return first + count; }

  uint64_t first, count;
};

}  // namespace vernier::test
