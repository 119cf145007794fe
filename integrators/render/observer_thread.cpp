// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/observer_thread.h"

namespace vernier {

ObserverThread::ObserverThread(std::function<void(const RenderProgress&)> observe)
    : observe_(std::move(observe)) {
  if (observe_) thread_ = std::thread([this] { run(); });
}

ObserverThread::~ObserverThread() {
  if (!observe_) return;
  {
    const std::lock_guard lock(mutex_);
    at_end_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void ObserverThread::post(const RenderProgress& progress) {
  posted_ = progress.seconds;
  {
    const std::lock_guard lock(mutex_);
    news_ = progress;
  }
  changed_.notify_one();
}

void ObserverThread::run() {
  while (true) {
    std::optional<RenderProgress> told;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return news_ || at_end_; });
      if (!news_) return;
      std::swap(told, news_);
    }
    try {
      observe_(*told);
    } catch (...) {
      return;
    }
  }
}

}  // namespace vernier
