// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace vernier {

/// Calls body(i) for i in [0, count) on the threads there are, in no stated order.
template <typename Body>
void parallel_for(size_t count, const Body& body) {
  tbb::parallel_for(size_t{0}, count, body);
}

/// Bounds the number of threads for as long as it lives; 0 means all of the machine's.
class ThreadLimit {
 public:
  explicit ThreadLimit(unsigned threads);

 private:
  tbb::global_control control_;
};

/// Threads in use under the current limit.
unsigned thread_count();

}  // namespace vernier
