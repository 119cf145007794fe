// SPDX-License-Identifier: Apache-2.0
#include "tests/support/memory_watch.h"

#include <algorithm>
#include <atomic>

#ifdef VERNIER_SANITIZED
// GCC does not ship the header that declares them, sanitizer/allocator_interface.h.
extern "C" {
size_t __sanitizer_get_current_allocated_bytes();
int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, size_t),
                                              void (*on_free)(const volatile void*));
}
#endif

namespace vernier::test {
namespace {

std::atomic<size_t> peak{0};

#ifdef VERNIER_SANITIZED
size_t allocated() { return __sanitizer_get_current_allocated_bytes(); }

void notice(const volatile void*, size_t size) {
  constexpr size_t large = size_t{1} << 20;
  if (size < large) return;
  const size_t now = allocated();
  size_t known = peak;
  while (known < now && !peak.compare_exchange_weak(known, now)) {
  }
}

void start_noticing() {
  static const int installed = __sanitizer_install_malloc_and_free_hooks(notice, [](const volatile void*) {});
  static_cast<void>(installed);
}
#else
size_t allocated() { return 0; }
void start_noticing() {}
#endif

}  // namespace

MemoryWatch::MemoryWatch() : before_(allocated()) {
  start_noticing();
  peak = before_;
}

size_t MemoryWatch::most() const { return std::max(peak.load(), before_) - before_; }

}  // namespace vernier::test
