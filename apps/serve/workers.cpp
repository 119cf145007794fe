// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/workers.h"

namespace vernier::apps {

Workers::Workers(size_t count) {
  for (size_t i = 0; i < count; ++i) threads_.emplace_back([this] { run(); });
}

Workers::Taken Workers::enqueue(std::function<void()> serve) {
  std::unique_lock lock(mutex_);
  is_free_.wait(lock, [this] { return free_ > 0 && !next_; });
  next_ = std::move(serve);
  is_given_.notify_one();
  return Taken(true);
}

void Workers::shutdown() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    is_given_.notify_all();
  }
  for (std::thread& thread : threads_) thread.join();
}

void Workers::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    ++free_;
    is_free_.notify_one();
    is_given_.wait(lock, [this] { return next_ || is_over_; });
    --free_;
    if (!next_) return;
    const auto serve = std::exchange(next_, nullptr);
    is_free_.notify_one();
    lock.unlock();
    serve();
    lock.lock();
  }
}

}  // namespace vernier::apps
