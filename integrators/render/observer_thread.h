// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "integrators/render/render.h"

namespace vernier {

/// Tells an observer of a render's progress on a thread of its own, so that one that does not return (a pipe
/// that nobody reads) holds up nothing that is rendered.
class ObserverThread {
 public:
  /// `observe` may be empty. After it has thrown it is not called again.
  explicit ObserverThread(std::function<void(const RenderProgress&)> observe);
  /// Waits until the observer has returned.
  ~ObserverThread();
  ObserverThread(const ObserverThread&) = delete;
  ObserverThread& operator=(const ObserverThread&) = delete;

  /// Whether so much time has passed since the last post() that there is something new to tell.
  bool is_due(double seconds) const { return observe_ && seconds - posted_ >= interval; }
  /// Takes the place of what has not been told yet. Called by one thread at a time.
  void post(const RenderProgress& progress);

 private:
  static constexpr double interval = 0.2;  ///< seconds

  void run();

  const std::function<void(const RenderProgress&)> observe_;
  double posted_ = 0;  ///< when, in seconds of rendering
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<RenderProgress> news_;
  bool at_end_ = false;
  std::thread thread_;
};

}  // namespace vernier
