// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/live_render.h"

#include <chrono>
#include <new>

#include "apps/serve/view_json.h"

namespace vernier::apps {

LiveRender::LiveRender(LiveScene& scene, const ViewFlags& flags, Audience& audience, FlagValues first)
    : scene_(scene),
      flags_(flags),
      audience_(audience),
      asked_{1, std::move(first)},
      picture_(scene, audience, stop_) {
  audience_.on_change([this] {
    const std::lock_guard lock(mutex_);
    if (!audience_.is_looking()) stop_ = true;
    news_.notify_all();
  });
  thread_ = std::thread([this] { run(); });
}

LiveRender::~LiveRender() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    stop_ = true;
    news_.notify_all();
  }
  thread_.join();
}

uint64_t LiveRender::change(const nlohmann::json& change) {
  const std::lock_guard one_at_a_time(change_mutex_);
  FlagValues now;
  {
    const std::lock_guard lock(mutex_);
    now = asked_.values;
  }
  FlagValues changed = flags_.changed(now, change);
  const std::lock_guard lock(mutex_);
  asked_ = {asked_.number + 1, std::move(changed)};
  stop_ = true;
  news_.notify_all();
  return asked_.number;
}

bool LiveRender::wait() {
  using namespace std::chrono_literals;
  std::unique_lock lock(mutex_);
  const auto has_work = [this] {
    return audience_.is_looking() && (asked_.number != begun_ || !is_complete_);
  };
  // A filter at work says nothing when it is done.
  while (!is_over_ && !has_work())
    if (news_.wait_for(lock, picture_.filter_is_running() ? 30ms : 1h) == std::cv_status::timeout) break;
  return !is_over_;
}

std::optional<LiveRender::View> LiveRender::take_view() {
  const std::lock_guard lock(mutex_);
  if (is_over_) return std::nullopt;
  stop_ = false;
  if (begun_ == asked_.number) return std::nullopt;
  begun_ = asked_.number;
  is_complete_ = false;
  return asked_;
}

void LiveRender::begin(const View& view) {
  NoticeLog log(true);
  const RenderRequest request = flags_.request(view.values);
  picture_.begin(request, view.number, log);
  audience_.tell("problem", "\"\"");  // that of a view before
  audience_.tell(
      "view",
      view_json(view.number, flags_.command(view.values), request, picture_.settings(), scene_, log).dump());
}

void LiveRender::run() {
  while (wait()) {
    std::string problem;
    bool goes_on = false;
    try {
      if (const auto view = take_view()) begin(*view);
      goes_on = picture_.advance();
    } catch (const std::bad_alloc&) {
      problem = "out of memory";
    } catch (const std::exception& error) {
      problem = error.what();
    }
    if (!problem.empty()) audience_.tell("problem", nlohmann::json(problem).dump());
    const std::lock_guard lock(mutex_);
    is_complete_ = !goes_on;
  }
}

}  // namespace vernier::apps
