// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace vernier::apps {

/// The pages that are open, and what they have been told. Of each kind of event only the newest is kept, so
/// that a page that reads slowly misses some and holds up nobody. All members may be called from any thread.
class Audience {
 public:
  /// A page's place, which it leaves when this is destroyed.
  class Seat {
   public:
    explicit Seat(Audience& audience) : audience_(audience) {}
    ~Seat();
    Seat(const Seat&) = delete;
    Seat& operator=(const Seat&) = delete;

    /// What there is to tell that this page has not been told, as text of an event stream (WHATWG HTML,
    /// "Server-sent events"). Waits for it, and returns a comment when there is nothing for a while; none:
    /// it is over.
    std::optional<std::string> next();

   private:
    Audience& audience_;
    uint64_t told_ = 0;
  };

  explicit Audience(size_t seats) : seats_(seats) {}

  /// Called whenever somebody comes, goes, or looks again. Before there are seats.
  void on_change(std::function<void()> call) { on_change_ = std::move(call); }

  /// Null when all places are taken.
  std::shared_ptr<Seat> admit();
  /// `kind` is a word, `data` one line.
  void tell(const std::string& kind, const std::string& data);
  /// A picture was made; some page fetched it.
  void note_picture();
  void note_fetch();
  /// Whether there is a page, and one of them has fetched the pictures that were made of late.
  bool is_looking() const;
  size_t size() const;
  /// Ends all streams, and admits nobody any more.
  void close();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds patience{10};     ///< until nobody is taken to look
  static constexpr std::chrono::seconds comment_time{5};  ///< so that dead connections are noticed

  struct News {
    uint64_t number;
    std::string data;
  };

  void leave();
  void tell_size();

  const size_t seats_;
  std::function<void()> on_change_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, News> news_;  ///< by kind
  uint64_t number_ = 0;               ///< of the newest
  size_t size_ = 0;
  std::optional<Clock::time_point> unseen_since_;  ///< when the first picture was made that nobody fetched
  bool is_closed_ = false;
};

}  // namespace vernier::apps
