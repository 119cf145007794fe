// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <vector>

#include "core/base/parallel.h"

namespace vernier {

/// parallel_for whose body may throw: all of them run, then the exception of the lowest index is rethrown, so
/// that which one a user sees does not depend on the threads.
template <typename Body>
void for_each_in_parallel(size_t count, const Body& body) {
  std::vector<std::exception_ptr> failures(count);
  parallel_for(count, [&](size_t i) {
    try {
      body(i);
    } catch (...) {
      failures[i] = std::current_exception();
    }
  });
  for (const auto& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace vernier
