// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/global_control.h>

#include <cstddef>

namespace vernier {

/// Calls part(loop, begin, end) for ranges that make up [0, count) on the threads there are. TBB's templates
/// are compiled in one place because ThreadSanitizer must leave that place alone: it does not see how TBB
/// hands tasks on, and to suppress what it says of TBB would suppress what it says of all that TBB calls.
void for_each_range(size_t count, const void* loop, void (*part)(const void* loop, size_t begin, size_t end));

/// Calls act(what), in which parallel loops of the calling thread wait for their own parts alone.
void call_isolated(const void* what, void (*act)(const void* what));

/// Calls body(i) for i in [0, count) on the threads there are, in no stated order.
template <typename Body>
void parallel_for(size_t count, const Body& body) {
  const auto loop = [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) body(i);
  };
  for_each_range(count, &loop, [](const void* erased, size_t begin, size_t end) {
    (*static_cast<const decltype(loop)*>(erased))(begin, end);
  });
}

/// parallel_for for who holds a lock: the calling thread takes on nothing else while it waits for the others,
/// which might ask for the same lock.
template <typename Body>
void parallel_for_isolated(size_t count, const Body& body) {
  const auto all = [&] { parallel_for(count, body); };
  call_isolated(&all, [](const void* erased) { (*static_cast<const decltype(all)*>(erased))(); });
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
