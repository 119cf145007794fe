// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <set>
#include <string>

#include "apps/vernier/picture_command.h"
#include "apps/vernier/render_picture.h"
#include "apps/vernier/stop_signals.h"

namespace vernier::apps {

/// Makes all pictures of a plan, one after the other: each scene is read once, built anew for each variant
/// and time, and stays as it is for all cameras and sides.
class RenderRun {
 public:
  RenderRun(RenderRequest request, RunPlan plan, PictureCommand command, std::string command_line);

  /// Done, or what the first failure or the signal that ended the run asks for. Throws Error when a picture
  /// fails and the run is not to go on.
  ExitCode execute();

 private:
  void render_scene(const std::string& scene);
  /// Every picture of a scene in one variant and at one time.
  void render_pose(SceneLoader& loader, const RenderFlags& flags, PictureName name);
  void render_view(PosedScene& posed, const View& view, const RenderFlags& flags, const PictureName& name);

  /// Whether all files of a picture are there and finished.
  bool exists(const RenderFlags& picture) const;
  /// Whether a picture is there and is to be left as it is, which is said.
  bool is_skipped(const RenderFlags& picture);
  /// The same for all pictures of a scene at one time, as far as they are known without reading it.
  bool is_pose_skipped(const std::string& scene, PictureName name);
  /// Throws Error(usage) when another picture of this run has been written to one of the files.
  void claim_files(const RenderFlags& picture);
  std::string command_for(const RenderFlags& picture, const View& view, const PictureName& name) const;

  /// Where so many pictures have failed by the exception being handled: throws it again, or says it and goes
  /// on, as the flags have it.
  void handle_failure(size_t pictures);
  void fail(size_t pictures, ExitCode code);
  void count_done(size_t pictures);
  PlaceInRun place() const;
  bool is_over() const { return is_stopped_ || (code_ != ExitCode::done && !keeps_going_); }

  const RenderRequest request_;
  const RunPlan plan_;
  const PictureCommand command_;
  const std::string command_line_;
  const bool keeps_going_;
  const WriteSignals write_signals_;
  NoticeLog log_;
  std::set<std::string> claimed_;  ///< files of the pictures so far
  ExitCode code_ = ExitCode::done;
  bool is_stopped_ = false;  ///< by a signal
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  size_t scenes_left_ = 0, scene_poses_ = 0;
  size_t scene_pictures_ = 0, scene_done_ = 0;   ///< of the scene under way
  size_t done_ = 0, rendered_ = 0, failed_ = 0;  ///< pictures; the first includes those skipped and failed
};

}  // namespace vernier::apps
