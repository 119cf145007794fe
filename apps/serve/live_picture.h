// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "apps/serve/audience.h"
#include "apps/serve/denoise_task.h"
#include "apps/serve/frame.h"
#include "apps/serve/live_scene.h"
#include "integrators/render/render.h"
#include "vernier/session.h"

namespace vernier::apps {

/// The picture of a view, rendered step by step: coarse ones, of few pixels, until there is one of the view's
/// own size, which then goes on to its limits. All members but frame() are for one thread.
class LivePicture {
 public:
  /// `stop` ends the step under way within about a tile.
  LivePicture(LiveScene& scene, Audience& audience, std::atomic<bool>& stop)
      : scene_(scene), audience_(audience), stop_(stop) {}

  /// Goes over to a view and makes its first picture, which `stop` does not keep it from. A render whose
  /// samples would be the same goes on. Throws Error.
  void begin(const RenderRequest& request, uint64_t view, NoticeLog& log);
  const RenderSettings& settings() const { return settings_; }

  /// One step; false: there is nothing left to do but wait for a filter,
  /// if filter_is_running().
  bool advance();
  bool filter_is_running() const { return task_ != nullptr; }

  /// The newest; null before the first. Callable from any thread.
  std::shared_ptr<const Frame> frame() const;

 private:
  void keep_or_restart(const RenderSettings& settings);
  /// What ends a step: nothing, as long as the view has no picture.
  const std::atomic<bool>& stop() const;
  void render_coarse();
  void publish_coarse();
  void render_on();
  void start_session();
  void note_speed(const RenderResult& result);
  void publish_render();
  void start_filter_if_due();
  void take_filtered();
  /// Whether there is a filtered picture, and it is what is shown.
  bool is_filtered() const { return filtered_ && filtered_->denoiser == request_.denoiser; }
  void publish_filtered();
  void publish(Frame frame);
  void tell();

  LiveScene& scene_;
  Audience& audience_;
  std::atomic<bool>& stop_;

  RenderRequest request_;
  RenderSettings settings_;
  uint64_t view_ = 0, scene_version_ = 0;
  bool has_picture_ = false;  ///< of these samples
  std::vector<int> steps_;    ///< of the coarse pictures that are still to come, in pixels
  double speed_ = 2e5;        ///< camera samples a second, as rendered last
  Image coarse_;              ///< the last of them
  int coarse_step_ = 1;

  uint64_t render_ = 0;                     ///< number of the session
  std::unique_ptr<RenderSession> session_;  ///< of the picture of full size; null: not begun
  int wanted_ = 0;                          ///< samples a pixel after the step under way
  bool is_step_done_ = true;
  std::optional<StopReason> ended_by_;  ///< none: it goes on
  double published_ = 0;                ///< seconds of rendering at the last time

  std::unique_ptr<DenoiseTask> task_;
  uint64_t task_render_ = 0;
  struct Filtered {
    double samples;  ///< a pixel, of what was filtered
    Denoised denoised;
    const Denoiser* denoiser;
  };
  std::optional<Filtered> filtered_;

  mutable std::mutex frame_mutex_;
  std::shared_ptr<const Frame> frame_;
};

}  // namespace vernier::apps
