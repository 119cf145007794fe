// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "apps/python/bindings.h"

namespace vernier::python {

/// A call on a thread of its own, which leaves the calling one to Python: only Python's main thread hears
/// Ctrl-C, and progress is told where it was asked for. To be made, waited for and destroyed with Python's
/// lock held.
class BackgroundCall {
 public:
  /// `work` gets a flag that asks it to end soon, and may tell() how far it is. It must not touch Python.
  using Work = std::function<void(const std::atomic<bool>& stop, BackgroundCall& call)>;
  explicit BackgroundCall(Work work);
  BackgroundCall(const BackgroundCall&) = delete;
  BackgroundCall& operator=(const BackgroundCall&) = delete;
  /// Stops the work and waits for its end.
  ~BackgroundCall();

  void tell(const RenderProgress& progress);

  /// Returns when the work is done, and calls `observe` with news until then. Throws what the work threw,
  /// what a signal handler of Python raised, or what `observe` did.
  void wait(const std::function<void(const RenderProgress&)>& observe);

 private:
  void call(const Work& work);
  /// Waits a little; true: the work is done.
  bool wait_for_news(std::optional<RenderProgress>& news);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<RenderProgress> latest_;
  bool is_done_ = false;
  std::exception_ptr failure_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;  ///< last, as it uses the others
};

}  // namespace vernier::python
