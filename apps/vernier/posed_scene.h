// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/vernier/choose_camera.h"
#include "apps/vernier/notice_log.h"
#include "apps/vernier/render_options.h"
#include "apps/vernier/render_report.h"
#include "apps/vernier/run_plan.h"
#include "scene/scene.h"
#include "vernier/scene_file.h"
#include "vernier/session.h"

namespace vernier::apps {

/// From where a picture is taken.
struct View {
  CameraDescription camera;
  std::string label;         ///< {camera}
  bool is_of_scene = false;  ///< rather than fitted or placed by flags
  std::optional<int> side;   ///< number of the picture of a turntable
  CameraDescription front;   ///< camera that a turntable begins with; without one, the same
  std::optional<std::array<CameraDescription, 2>> beside;  ///< of the turntable's pictures before and after
};

/// A scene at one time and in one variant, ready for pictures by any camera.
class PosedScene {
 public:
  /// Builds the scene, after seeing that it has the cameras asked for. Throws Error.
  PosedScene(const RenderFlags& flags, const RunPlan& plan, SceneDescription description, NoticeLog& log);

  /// Every camera and side that the plan has. Throws Error.
  std::vector<View> views(const RenderFlags& flags, const RunPlan& plan, NoticeLog& log) const;
  /// Puts the surroundings around it that a picture by this view needs, as if it were the only one, and says
  /// what they are. Whether a turntable needs a studio is told by its front, so that all of it has the same.
  Surroundings set_environment(const RenderRequest& request, const RenderSettings& settings, const View& view,
                               NoticeLog& log);

  const std::shared_ptr<Scene>& scene() const { return scene_; }
  /// What the report of each of its pictures begins with.
  const RenderReport& report() const { return report_; }
  void add_load_seconds(double seconds) { report_.load_seconds += seconds; }
  /// From the second picture on nothing is loaded or built.
  void forget_seconds() { report_.load_seconds = report_.build_seconds = 0; }

 private:
  RenderReport report_;
  std::vector<LabelledCamera> chosen_;
  std::shared_ptr<const EnvironmentDescription> own_;  ///< environment of the scene itself
  std::shared_ptr<Scene> scene_;
  std::optional<Surroundings> surroundings_;  ///< that are around it now
  std::optional<Transform> decided_by_;       ///< front of the turntable that they were chosen for
};

/// The pictures before and after one of an animation, of which only the geometry is looked at.
struct NeighborPoses {
  struct Pose {
    std::shared_ptr<const Scene> scene;
    std::vector<View> views;
  };
  Pose previous, next;

  /// For the picture by view `view` of the pose between them.
  Moments moments(size_t view) const {
    return {{previous.scene, previous.views.at(view).camera}, {next.scene, next.views.at(view).camera}};
  }
};

/// Reads a scene for all of its pictures.
class SceneLoader {
 public:
  explicit SceneLoader(const RenderRequest& request) : request_(request) {}

  /// Reads the file to keep it in memory, for several descriptions of it. Throws Error(input).
  void open(const std::string& scene);
  /// Of an open file.
  std::vector<std::string> variants() const { return file_->variants(); }
  /// Reads what has not been read yet, and builds the scene.
  std::unique_ptr<PosedScene> pose(const RenderFlags& flags, const RunPlan& plan, NoticeLog& log);
  /// The scene a frame before and after the time in the flags.
  NeighborPoses neighbors(const RenderFlags& flags, const RunPlan& plan);

 private:
  const RenderRequest& request_;
  std::optional<SceneFile> file_;
  double load_seconds_ = 0;  ///< of the file, until a scene is made of it
};

}  // namespace vernier::apps
