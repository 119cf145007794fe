// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/audience.h"

#include <fmt/format.h>

namespace vernier::apps {

Audience::Seat::~Seat() { audience_.leave(); }

std::optional<std::string> Audience::Seat::next() {
  std::unique_lock lock(audience_.mutex_);
  audience_.changed_.wait_for(lock, comment_time,
                              [&] { return audience_.is_closed_ || audience_.number_ > told_; });
  if (audience_.is_closed_) return std::nullopt;
  std::string text;
  for (const auto& [kind, news] : audience_.news_)
    if (news.number > told_) text += fmt::format("event: {}\ndata: {}\n\n", kind, news.data);
  told_ = audience_.number_;
  return text.empty() ? ":\n\n" : text;
}

std::shared_ptr<Audience::Seat> Audience::admit() {
  {
    const std::lock_guard lock(mutex_);
    if (is_closed_ || size_ >= seats_) return nullptr;
    ++size_;
    unseen_since_.reset();
  }
  auto seat = std::make_shared<Seat>(*this);
  tell_size();
  return seat;
}

void Audience::leave() {
  {
    const std::lock_guard lock(mutex_);
    --size_;
  }
  tell_size();
}

void Audience::tell_size() {
  tell("people", std::to_string(size()));
  if (on_change_) on_change_();
}

void Audience::tell(const std::string& kind, const std::string& data) {
  const std::lock_guard lock(mutex_);
  news_[kind] = {++number_, data};
  changed_.notify_all();
}

void Audience::note_picture() {
  const std::lock_guard lock(mutex_);
  if (!unseen_since_) unseen_since_ = Clock::now();
}

void Audience::note_fetch() {
  {
    const std::lock_guard lock(mutex_);
    const bool was_away = unseen_since_ && Clock::now() - *unseen_since_ > patience;
    unseen_since_.reset();
    if (!was_away) return;
  }
  if (on_change_) on_change_();
}

bool Audience::is_looking() const {
  const std::lock_guard lock(mutex_);
  return !is_closed_ && size_ > 0 && !(unseen_since_ && Clock::now() - *unseen_since_ > patience);
}

size_t Audience::size() const {
  const std::lock_guard lock(mutex_);
  return size_;
}

void Audience::close() {
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  changed_.notify_all();
}

}  // namespace vernier::apps
