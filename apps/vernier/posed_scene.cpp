// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/posed_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "apps/vernier/fog_flag.h"
#include "apps/vernier/memory_limit.h"
#include "apps/vernier/scene_summary.h"
#include "apps/vernier/stopwatch.h"
#include "scene/subject.h"
#include "scene/turntable.h"
#include "vernier/ground.h"

namespace vernier::apps {
namespace {

/// Puts the views of a turntable, all from one camera, at the end of `views`.
void add_sides(const View& view, const Vec3f& center, const RunPlan& plan, const RenderFlags& flags,
               std::vector<View>& views) {
  for (const auto side : plan.sides) {
    views.push_back(view);
    views.back().side = side;
    if (!side) continue;
    const auto camera_of = [&](int picture) {
      return carried_around(view.camera, center,
                            2 * std::numbers::pi * double(picture - 1) / plan.sides_around);
    };
    views.back().camera = camera_of(*side);
    if (const auto& shutter = flags.import.shutter) {
      const auto angle_of = [&](double seconds) {
        return 2 * std::numbers::pi * (*side - 1 + seconds / frame_seconds(flags.run)) / plan.sides_around;
      };
      views.back().camera =
          carried_on(view.camera, center, angle_of(shutter->open), angle_of(shutter->close));
    }
    views.back().beside = {camera_of(*side - 1), camera_of(*side + 1)};
  }
}

}  // namespace

PosedScene::PosedScene(const RenderFlags& flags, const RunPlan& plan, SceneDescription description,
                       NoticeLog& log)
    : own_(description.environment) {
  report_.scene_file = flags.scene;
  report_.scene_hash = description.hash;
  report_.counts = count(description);
  const auto& cameras = description.cameras;
  if (!plan.all_cameras)
    chosen_ = {{choose_camera(cameras, flags.camera, log), ""}};
  else if (cameras.empty())
    chosen_ = {{std::nullopt, ""}};  // one that is fitted stands for all that there are
  else
    chosen_ = all_cameras(cameras, log);
  if (flags.camera.ground) add_ground(description, *flags.camera.ground);
  check_scene_size(description, flags.import.memory);
  Stopwatch watch;
  scene_ = build_scene(std::move(description), {flags.accelerator});
  report_.build_seconds = watch.lap();
  if (const Fog fog = parse_fog(flags.fog); fog.density > 0) {
    scene_->fill_air(fog);
    log.add({Notice::Severity::info,
             {},
             fmt::format("fog fills a ball of {:.3g} m about the scene", scene_->fog().radius)});
  }
  if (flags.integrator == "whitted" && scene_->volumes().scatter())
    log.add({Notice::Severity::info, {}, "whitted lets fog and other media dim light, and scatters none"});
  report_.accelerator = scene_->accelerator_name();
  report_.accelerator_stats = scene_->accelerator().stats();
}

std::vector<View> PosedScene::views(const RenderFlags& flags, const RunPlan& plan, NoticeLog& log) const {
  const float aspect = asked_aspect(flags.size);
  const Vec3f center = Subject(scene_->geometry()).bounds_to_see().center();
  std::vector<View> views;
  for (const auto& [camera, label] : chosen_) {
    View view;
    view.camera = place_camera(camera, flags.camera, scene_->geometry(), aspect, log);
    view.front = view.camera;
    view.label = label.empty() ? view.camera.name : label;
    view.is_of_scene = camera.has_value();
    add_sides(view, center, plan, flags, views);
  }
  const bool any_moves =
      std::any_of(views.begin(), views.end(), [](const View& view) { return !view.camera.moments.empty(); });
  if (flags.import.shutter && !scene_->moves() && !any_moves)
    log.add({Notice::Severity::info, "--shutter", "nothing moves while it is open"});
  return views;
}

Surroundings PosedScene::set_environment(const RenderRequest& request, const RenderSettings& settings,
                                         const View& view, NoticeLog& log) {
  const std::optional<Surroundings>& asked = request.surroundings;
  if (surroundings_ && asked && !asked->turns_with_camera) return *surroundings_;
  const bool is_decided = !asked && view.side && decided_by_ == view.front.to_world;
  if (!is_decided) {
    if (surroundings_ && surroundings_->environment) scene_->set_environment(own_);
    surroundings_ = apps::set_environment(*scene_, asked, asked ? view.camera : view.front, settings, log);
    decided_by_ = view.front.to_world;
  }
  if (!asked && view.side && surroundings_->environment)
    scene_->set_environment(built_in_environment(surroundings_->name, view.camera));
  return *surroundings_;
}

void SceneLoader::open(const std::string& scene) {
  if (file_) return;
  Stopwatch watch;
  file_.emplace(scene, request_.flags.import.allow_outside_files);
  load_seconds_ = watch.lap();
}

std::unique_ptr<PosedScene> SceneLoader::pose(const RenderFlags& flags, const RunPlan& plan, NoticeLog& log) {
  Stopwatch watch;
  SceneDescription description =
      file_ ? file_->describe(flags.import) : import_scene(flags.scene, flags.import);
  replace_surroundings(description, request_.surroundings, log);
  log.add(description.notices);
  const double seconds = std::exchange(load_seconds_, 0) + watch.lap();
  auto posed = std::make_unique<PosedScene>(flags, plan, std::move(description), log);
  posed->add_load_seconds(seconds);
  return posed;
}

NeighborPoses SceneLoader::neighbors(const RenderFlags& flags, const RunPlan& plan) {
  const auto pose_at = [&](double seconds) -> NeighborPoses::Pose {
    NoticeLog unsaid(true);  // what is to be said of the scene is said of the picture itself
    RenderFlags other = flags;
    other.import.time = seconds;
    other.import.shutter.reset();
    const auto posed = pose(other, plan, unsaid);
    return {posed->scene(), posed->views(other, plan, unsaid)};
  };
  // Where it is in a picture is where it is in the middle of the shutter.
  const auto shutter = flags.import.shutter.value_or(Shutter{});
  const double time = flags.import.time.value_or(0) + (shutter.open + shutter.close) / 2;
  const double step = frame_seconds(flags.run);
  return {pose_at(time - step), pose_at(time + step)};
}

}  // namespace vernier::apps
