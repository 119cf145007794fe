// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#ifdef VERNIER_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace vernier {
namespace {

/// Tells ThreadSanitizer that a loop's parts run after what was before the loop and before what is after it.
/// Nothing in other builds.
class ForkJoin {
 public:
#ifdef VERNIER_TSAN
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

}  // namespace

void for_each_range(size_t count, const void* loop, void (*part)(const void*, size_t, size_t)) {
  [[maybe_unused]] ForkJoin order;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count), [&](const tbb::blocked_range<size_t>& range) {
    order.begin();
    part(loop, range.begin(), range.end());
    order.end();
  });
}

void call_isolated(const void* what, void (*act)(const void*)) {
  tbb::this_task_arena::isolate([&] { act(what); });
}

ThreadLimit::ThreadLimit(unsigned threads)
    : control_(tbb::global_control::max_allowed_parallelism,
               threads ? threads : static_cast<size_t>(tbb::info::default_concurrency())) {}

unsigned thread_count() {
  return static_cast<unsigned>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace vernier
