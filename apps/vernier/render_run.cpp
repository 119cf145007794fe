// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/render_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <new>
#include <nlohmann/json.hpp>

#include "apps/vernier/messages.h"
#include "apps/vernier/picture_output.h"

namespace vernier::apps {
namespace {

bool knows_names_without_scene(const RunPlan& plan) {
  for (const FilePattern& output : plan.files.outputs)
    if (output.has(Placeholder::camera)) return false;
  return true;
}

/// Folders that are called after a picture.
void make_named_folders(const RenderFlags& picture, const FilePatterns& files) {
  for (size_t i = 0; i < picture.outputs.size(); ++i) {
    if (!files.outputs[i].names_folder()) continue;
    make_folder_of(picture.outputs[i]);
    check_output(picture.outputs[i], false);
  }
  const auto make = [](const std::optional<FilePattern>& pattern, const std::string& file) {
    if (pattern && pattern->names_folder()) make_folder_of(file);
  };
  make(files.stats, picture.stats);
  make(files.report, picture.report);
  make(files.checkpoint, picture.checkpoint);
}

}  // namespace

RenderRun::RenderRun(RenderRequest request, RunPlan plan, PictureCommand command, std::string command_line)
    : request_(std::move(request)),
      plan_(std::move(plan)),
      command_(std::move(command)),
      command_line_(std::move(command_line)),
      keeps_going_(request_.flags.run.keep_going),
      log_(request_.flags.quiet) {}

ExitCode RenderRun::execute() {
  scenes_left_ = plan_.scenes.size();
  for (const std::string& scene : plan_.scenes) {
    if (is_over()) break;
    --scenes_left_;
    scene_done_ = 0;
    scene_pictures_ = plan_.variants.size() * plan_.times.size() * plan_.sides.size();
    try {
      render_scene(scene);
    } catch (...) {
      handle_failure(scene_pictures_ - std::min(scene_pictures_, scene_done_));
    }
  }
  if (failed_ > 0 && done_ > 1) print_error(fmt::format("{} of {} pictures failed", failed_, done_));
  return is_stopped_ && code_ == ExitCode::done ? ExitCode::stopped : code_;
}

void RenderRun::render_scene(const std::string& scene) {
  SceneLoader loader(request_);
  std::vector<std::string> variants = plan_.variants;
  if (plan_.all_variants) {
    loader.open(scene);
    variants = loader.variants();
  }
  if (variants.empty())
    throw Error(ErrorKind::usage, scene, {}, "has no variants of its materials; leave --variant out");
  scene_poses_ = variants.size() * plan_.times.size();
  scene_pictures_ = scene_poses_ * plan_.sides.size();
  for (const std::string& variant : variants)
    for (const auto& time : plan_.times) {
      if (is_over()) return;
      const PictureName name{stem_of(scene), "", variant, time};
      if (is_pose_skipped(scene, name)) continue;
      if (scene_poses_ > 1) loader.open(scene);
      const std::string detail = plan_.times.size() > 1 ? fmt::format("frame {}", *time)
                                 : variants.size() > 1  ? fmt::format("variant '{}'", variant)
                                                        : "";
      log_.begin_pose(plan_.scenes.size() > 1 ? scene : "", detail);
      const size_t before = scene_done_;
      try {
        render_pose(loader, flags_for(request_.flags, plan_, scene, name), name);
      } catch (...) {
        handle_failure(plan_.sides.size() - std::min(plan_.sides.size(), scene_done_ - before));
      }
    }
}

void RenderRun::render_pose(SceneLoader& loader, const RenderFlags& flags, PictureName name) {
  const auto posed = loader.pose(flags, plan_, log_);
  if (done_ == 0) posed->add_load_seconds(request_.check_seconds);
  const std::vector<View> views = posed->views(flags, plan_, log_);
  scene_pictures_ = scene_poses_ * views.size();
  for (size_t i = 0; i < views.size() && !is_over(); ++i) {
    const View& view = views[i];
    name.camera = view.label;
    if (view.side) name.frame = view.side;
    log_.begin_picture(i == 0      ? ""
                       : view.side ? fmt::format("frame {}", *view.side)
                                   : fmt::format("camera '{}'", view.label));
    try {
      render_view(*posed, view, flags_for(request_.flags, plan_, flags.scene, name), name);
    } catch (...) {
      handle_failure(1);
    }
    posed->forget_seconds();
  }
}

void RenderRun::render_view(PosedScene& posed, const View& view, const RenderFlags& flags,
                            const PictureName& name) {
  claim_files(flags);
  if (is_skipped(flags)) return;
  make_named_folders(flags, plan_.files);
  RenderRequest request = request_;
  request.flags = flags;
  const PictureContext context{command_line_, command_for(flags, view, name), place(), write_signals_.now()};
  const auto [code, is_stopped] = render_picture(request, posed, view, context, log_);
  ++rendered_;
  is_stopped_ = is_stopped;
  if (code == ExitCode::done || code == ExitCode::stopped)
    count_done(1);
  else
    fail(1, code);
}

bool RenderRun::is_pose_skipped(const std::string& scene, PictureName name) {
  if (!request_.flags.run.skip_existing || plan_.all_cameras || !knows_names_without_scene(plan_))
    return false;
  std::vector<RenderFlags> pictures;
  for (const auto& side : plan_.sides) {
    if (side) name.frame = side;
    pictures.push_back(flags_for(request_.flags, plan_, scene, name));
    if (!exists(pictures.back())) return false;
  }
  for (const RenderFlags& picture : pictures) is_skipped(picture);
  return true;
}

bool RenderRun::exists(const RenderFlags& picture) const {
  return std::all_of(picture.outputs.begin(), picture.outputs.end(), is_finished_picture);
}

bool RenderRun::is_skipped(const RenderFlags& picture) {
  if (!request_.flags.run.skip_existing || !exists(picture)) return false;
  if (!picture.quiet) fmt::print("skipped {}: it is there\n", fmt::join(picture.outputs, ", "));
  print_event({{"event", "skipped"}, {"outputs", picture.outputs}});
  count_done(1);
  return true;
}

void RenderRun::claim_files(const RenderFlags& picture) {
  std::vector<std::string> files = picture.outputs;
  files.insert(files.end(), {picture.stats, picture.report, picture.checkpoint});
  for (const std::string& file : files)
    if (!file.empty() && !claimed_.insert(file).second)
      throw Error(ErrorKind::usage, file, {},
                  "is the file of another picture of this run, which has the same names in its placeholders");
}

std::string RenderRun::command_for(const RenderFlags& picture, const View& view,
                                   const PictureName& name) const {
  std::map<std::string, std::string> instead;
  if (plan_.times[0]) instead["--at"] = fmt::format("{}", *picture.import.time);
  if (plan_.all_variants) instead["--variant"] = name.variant;
  if (plan_.all_cameras) instead["--camera"] = view.is_of_scene ? view.label : "";
  if (view.side) instead["--frames"] = std::to_string(*view.side);
  return command_.text(picture.scene, instead);
}

void RenderRun::handle_failure(size_t pictures) {
  if (!keeps_going_) throw;
  try {
    throw;
  } catch (const Error& error) {
    print_error(error.what());
    fail(pictures, exit_code(error.kind()));
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
    fail(pictures, ExitCode::memory);
  }
}

/// The first failure makes the exit code.
void RenderRun::fail(size_t pictures, ExitCode code) {
  if (code_ == ExitCode::done) code_ = code;
  failed_ += pictures;
  count_done(pictures);
}

void RenderRun::count_done(size_t pictures) {
  done_ += pictures;
  scene_done_ += pictures;
}

PlaceInRun RenderRun::place() const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  const size_t left =
      scene_pictures_ - std::min(scene_pictures_, scene_done_) + scenes_left_ * scene_pictures_;
  return {done_ + 1, done_ + std::max<size_t>(left, 1), rendered_, elapsed.count()};
}

}  // namespace vernier::apps
