// SPDX-License-Identifier: Apache-2.0
#include "apps/python/background_call.h"

#include <chrono>
#include <utility>

namespace vernier::python {

BackgroundCall::BackgroundCall(Work work) : thread_([this, work = std::move(work)] { call(work); }) {}

BackgroundCall::~BackgroundCall() {
  stop_ = true;
  const py::gil_scoped_release unlocked;
  thread_.join();
}

void BackgroundCall::call(const Work& work) {
  std::exception_ptr failure;
  try {
    work(stop_, *this);
  } catch (...) {
    failure = std::current_exception();
  }
  const std::scoped_lock lock(mutex_);
  failure_ = failure;
  is_done_ = true;
  changed_.notify_all();
}

void BackgroundCall::tell(const RenderProgress& progress) {
  const std::scoped_lock lock(mutex_);
  latest_ = progress;
  changed_.notify_all();
}

bool BackgroundCall::wait_for_news(std::optional<RenderProgress>& news) {
  using namespace std::chrono_literals;
  const py::gil_scoped_release unlocked;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, 50ms, [&] { return is_done_ || latest_; });
  news = std::exchange(latest_, std::nullopt);
  return is_done_;
}

void BackgroundCall::wait(const std::function<void(const RenderProgress&)>& observe) {
  for (bool is_done = false; !is_done;) {
    std::optional<RenderProgress> news;
    is_done = wait_for_news(news);
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (news && observe) observe(*news);
  }
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace vernier::python
