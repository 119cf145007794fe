// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

namespace vernier {

void for_each_range(size_t count, const void* loop, void (*part)(const void*, size_t, size_t)) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count),
                    [=](const tbb::blocked_range<size_t>& range) { part(loop, range.begin(), range.end()); });
}

ThreadLimit::ThreadLimit(unsigned threads)
    : control_(tbb::global_control::max_allowed_parallelism,
               threads ? threads : static_cast<size_t>(tbb::info::default_concurrency())) {}

unsigned thread_count() {
  return static_cast<unsigned>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace vernier
