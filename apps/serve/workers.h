// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace vernier::apps {

/// Threads that serve one connection each. While all are taken nobody is let in: further connections wait
/// in the kernel, which keeps a few and refuses the rest.
class Workers : public httplib::TaskQueue {
 public:
  explicit Workers(size_t count);

  /// What it returns depends on the version of cpp-httplib: nothing, or whether it was taken.
  using Taken = decltype(std::declval<httplib::TaskQueue>().enqueue(nullptr));
  Taken enqueue(std::function<void()> serve) override;
  void shutdown() override;

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable is_free_, is_given_;
  std::function<void()> next_;  ///< empty: none waits for a thread
  size_t free_ = 0;
  bool is_over_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace vernier::apps
