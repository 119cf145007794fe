// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <cstddef>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace vernier {

/// Tells ThreadSanitizer, which sees nothing of TBB's library, that a loop's body runs after what was before
/// the loop and before what is after it. Nothing in other builds.
class ForkJoin {
 public:
#ifdef __SANITIZE_THREAD__
  ForkJoin() { __tsan_release(&fork_); }
  ~ForkJoin() { __tsan_acquire(&join_); }
  void begin() { __tsan_acquire(&fork_); }
  void end() { __tsan_release(&join_); }

 private:
  char fork_ = 0, join_ = 0;
#else
  void begin() {}
  void end() {}
#endif
};

/// Calls body(i) for i in [0, count) on the threads there are, in no stated order.
template <typename Body>
void parallel_for(size_t count, const Body& body) {
  [[maybe_unused]] ForkJoin order;
  tbb::parallel_for(size_t{0}, count, [&](size_t i) {
    order.begin();
    body(i);
    order.end();
  });
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
