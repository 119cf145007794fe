// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/vernier/load_ahead.h"
#include "apps/vernier/picture_command.h"
#include "apps/vernier/render_picture.h"
#include "apps/vernier/stop_signals.h"

namespace vernier::apps {

/// What runs that follow each other share.
struct RunResources {
  EnvironmentPictures environments;
  LoadAhead ahead;
};

/// Pictures of the runs before and after one.
struct PlaceAmongRuns {
  size_t pictures_before = 0, pictures_after = 0, rendered_before = 0;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();  ///< of the first
};

/// Makes all pictures of a plan, one after the other: each scene is read once, built anew for each variant
/// and time, and stays as it is for all cameras and sides. While one is rendered the next is loaded, where
/// that can be afforded.
class RenderRun {
 public:
  RenderRun(RenderRequest request, RunPlan plan, PictureCommand command, std::string command_line,
            RunResources& resources);
  ~RenderRun() { resources_.ahead.wait(); }  // which may be using this run or the next
  RenderRun(const RenderRun&) = delete;
  RenderRun& operator=(const RenderRun&) = delete;

  /// Done, or what the first failure or the signal that ended the run asks for. Throws Error when a picture
  /// fails and the run is not to go on.
  ExitCode execute(const PlaceAmongRuns& place = {});
  /// The run that comes after this one, whose first scene is loaded while the last of this is rendered.
  void set_next(RenderRun* next) { next_run_ = next; }

  /// Pictures of the plan, as far as they are known before the scenes are read.
  size_t planned() const { return plan_.scenes.size() * pictures_of_scene(); }
  const std::string& command_line() const { return command_line_; }
  size_t done() const { return done_; }
  size_t rendered() const { return rendered_; }
  bool is_stopped() const { return is_stopped_; }

 private:
  /// Decodes what the flags name, once.
  void prepare();
  void render_scene(size_t index);
  /// Every picture of a scene in one variant and at one time, `poses[at]`.
  void render_pose(const std::vector<PictureName>& poses, size_t at);
  void render_view(PosedScene& posed, const View& view, const RenderFlags& flags, const PictureName& name,
                   std::optional<Moments> moments);

  /// Whether all files of a picture are there and finished.
  bool exists(const RenderFlags& picture) const;
  /// Whether a picture is there and is to be left as it is, which is said.
  bool is_skipped(const RenderFlags& picture);
  /// The pictures of a scene at one time, where all are there and to be left as they are, as far as that is
  /// known without reading it; else none.
  std::vector<RenderFlags> skipped_pictures(const std::string& scene, PictureName name) const;
  bool is_pose_skipped(const std::string& scene, const PictureName& name);
  std::vector<PictureName> poses_of(const std::string& scene, const std::vector<std::string>& variants) const;
  size_t pictures_of_scene() const;

  /// Starts to load what comes after `poses[at]` of the scene under way, if there is time and room for it.
  void load_next(const std::vector<PictureName>& poses, size_t at);
  /// The same for the first scene from this one on of which a picture is missing; false when there is none.
  bool load_scene(size_t index);
  void load_pose(std::shared_ptr<SceneLoader> loader, size_t scene, const PictureName& name, bool keeps_file);
  /// Throws Error(usage) when another picture of this run has been written to one of the files.
  void claim_files(const RenderFlags& picture);
  std::string command_for(const RenderFlags& picture, const View& view, const PictureName& name) const;

  /// Where so many pictures have failed by the exception being handled: throws it again, or says it and goes
  /// on, as the flags have it.
  void handle_failure(size_t pictures);
  void fail(size_t pictures, ExitCode code);
  void count_done(size_t pictures);
  PlaceInRun place_in_run() const;
  bool is_over() const { return is_stopped_ || (code_ != ExitCode::done && !keeps_going_); }

  RenderRequest request_;  ///< complete once prepare() has been called
  const RunPlan plan_;
  const PictureCommand command_;
  const std::string command_line_;
  const bool keeps_going_;
  RunResources& resources_;
  RenderRun* next_run_ = nullptr;
  PlaceAmongRuns place_;
  NoticeLog log_;
  bool is_prepared_ = false;
  const bool shows_motion_;
  std::shared_ptr<SceneLoader> loader_;  ///< of the scene under way
  std::shared_ptr<SceneLoader> next_loader_;
  size_t scene_ = 0, next_scene_ = 0;  ///< numbers of these scenes
  std::set<std::string> claimed_;      ///< files of the pictures so far
  ExitCode code_ = ExitCode::done;
  bool is_stopped_ = false;                 ///< by a signal
  std::atomic<bool>* write_now_ = nullptr;  ///< while the run goes on
  size_t scenes_left_ = 0, scene_poses_ = 0;
  size_t scene_pictures_ = 0, scene_done_ = 0;   ///< of the scene under way
  size_t done_ = 0, rendered_ = 0, failed_ = 0;  ///< pictures; the first includes those skipped and failed
};

}  // namespace vernier::apps
