// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/serve/live_picture.h"
#include "apps/serve/view_flags.h"

namespace vernier::apps {

/// Renders what its audience asks to see, on a thread of its own, as long as there is one. All members may be
/// called from any thread.
class LiveRender {
 public:
  /// `scene` has been prepared for `first`.
  LiveRender(LiveScene& scene, const ViewFlags& flags, Audience& audience, FlagValues first);
  ~LiveRender();
  LiveRender(const LiveRender&) = delete;
  LiveRender& operator=(const LiveRender&) = delete;

  /// Asks for another view and returns its number. The next one takes its place if it comes before this one
  /// is begun. Throws Error(usage).
  uint64_t change(const nlohmann::json& change);

  std::shared_ptr<const Frame> frame() const { return picture_.frame(); }

 private:
  struct View {
    uint64_t number;
    FlagValues values;
  };

  void run();
  /// Waits until there is something to do: a view to begin, or a picture to go on with. False: it is over.
  bool wait();
  /// The one asked for, once.
  std::optional<View> take_view();
  void begin(const View& view);

  LiveScene& scene_;
  const ViewFlags& flags_;
  Audience& audience_;

  std::mutex change_mutex_;  ///< one change is made at a time
  std::mutex mutex_;
  std::condition_variable news_;
  View asked_;                ///< last
  uint64_t begun_ = 0;        ///< number of the view
  bool is_complete_ = false;  ///< its picture
  bool is_over_ = false;
  std::atomic<bool> stop_{false};
  LivePicture picture_;
  std::thread thread_;
};

}  // namespace vernier::apps
