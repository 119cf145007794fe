// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <tbb/info.h>

namespace vernier {

ThreadLimit::ThreadLimit(unsigned threads)
    : control_(tbb::global_control::max_allowed_parallelism,
               threads ? threads : static_cast<size_t>(tbb::info::default_concurrency())) {}

unsigned thread_count() {
  return static_cast<unsigned>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace vernier
