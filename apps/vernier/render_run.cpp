// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/render_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <nlohmann/json.hpp>

#include "apps/vernier/messages.h"
#include "apps/vernier/picture_output.h"
#include "apps/vernier/stopwatch.h"
#include "core/base/parallel.h"

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

RenderRun::RenderRun(RenderRequest request, RunPlan plan, PictureCommand command, std::string command_line,
                     RunResources& resources)
    : request_(std::move(request)),
      plan_(std::move(plan)),
      command_(std::move(command)),
      command_line_(std::move(command_line)),
      keeps_going_(request_.flags.run.keep_going),
      resources_(resources),
      log_(request_.flags.quiet),
      shows_motion_(shows_motion(request_.flags)) {}

ExitCode RenderRun::execute(const PlaceAmongRuns& place) {
  const ThreadLimit threads(request_.flags.threads);
  const WriteSignals write_signals;
  write_now_ = &write_signals.now();
  place_ = place;
  resources_.ahead.wait();  // it may be preparing this run
  prepare();
  scenes_left_ = plan_.scenes.size();
  for (size_t scene = 0; scene < plan_.scenes.size() && !is_over(); ++scene) {
    --scenes_left_;
    scene_done_ = 0;
    scene_pictures_ = pictures_of_scene();
    try {
      render_scene(scene);
    } catch (...) {
      handle_failure(scene_pictures_ - std::min(scene_pictures_, scene_done_));
    }
  }
  if (failed_ > 0 && done_ > 1) print_error(fmt::format("{} of {} pictures failed", failed_, done_));
  return is_stopped_ && code_ == ExitCode::done ? ExitCode::stopped : code_;
}

size_t RenderRun::pictures_of_scene() const {
  return plan_.variants.size() * plan_.times.size() * plan_.sides.size();
}

void RenderRun::prepare() {
  if (std::exchange(is_prepared_, true)) return;
  Stopwatch watch;
  Background& background = request_.settings.background;
  background.picture = read_background_picture(request_.flags.background, request_.flags.import.memory.bytes);
  // A session that makes one of its own size of it begins with a copy.
  if (background.picture)
    request_.flags.import.memory.elsewhere += background.picture->values.size() * sizeof(float);
  request_.surroundings = read_surroundings(request_.flags.surroundings, resources_.environments);
  request_.check_seconds += watch.lap();
}

std::vector<PictureName> RenderRun::poses_of(const std::string& scene,
                                             const std::vector<std::string>& variants) const {
  std::vector<PictureName> poses;
  for (const std::string& variant : variants)
    for (const auto& time : plan_.times) poses.push_back({stem_of(scene), "", variant, time});
  return poses;
}

void RenderRun::render_scene(size_t index) {
  scene_ = index;
  const std::string& scene = plan_.scenes[index];
  const bool is_loading = next_loader_ && next_scene_ == index;
  loader_ = is_loading ? std::move(next_loader_) : std::make_shared<SceneLoader>(request_);
  next_loader_.reset();
  std::vector<std::string> variants = plan_.variants;
  if (plan_.all_variants) {
    resources_.ahead.wait();
    loader_->open(scene);
    variants = loader_->variants();
  }
  if (variants.empty())
    throw Error(ErrorKind::usage, scene, {}, "has no variants of its materials; leave --variant out");
  scene_poses_ = variants.size() * plan_.times.size();
  scene_pictures_ = scene_poses_ * plan_.sides.size();
  const std::vector<PictureName> poses = poses_of(scene, variants);
  for (size_t at = 0; at < poses.size() && !is_over(); ++at) {
    const PictureName& name = poses[at];
    if (is_pose_skipped(scene, name)) continue;
    const std::string detail = plan_.times.size() > 1 ? fmt::format("frame {}", *name.frame)
                               : variants.size() > 1  ? fmt::format("variant '{}'", name.variant)
                                                      : "";
    log_.begin_pose(plan_.scenes.size() > 1 ? scene : "", detail);
    const size_t before = scene_done_;
    try {
      render_pose(poses, at);
    } catch (...) {
      handle_failure(plan_.sides.size() - std::min(plan_.sides.size(), scene_done_ - before));
    }
  }
}

void RenderRun::render_pose(const std::vector<PictureName>& poses, size_t at) {
  PictureName name = poses[at];
  const RenderFlags flags = flags_for(request_.flags, plan_, plan_.scenes[scene_], name);
  auto posed = resources_.ahead.take({loader_, name.variant, name.frame}, log_);
  if (!posed) {
    if (scene_poses_ > 1 || shows_motion_) loader_->open(flags.scene);
    posed = loader_->pose(flags, plan_, log_);
  }
  std::optional<NeighborPoses> neighbors;
  if (shows_motion_ && !plan_.sides[0]) neighbors = loader_->neighbors(flags, plan_);
  load_next(poses, at);
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
      std::optional<Moments> moments;
      if (neighbors) moments = neighbors->moments(i);
      if (shows_motion_ && view.beside)
        moments = Moments{{posed->scene(), (*view.beside)[0]}, {posed->scene(), (*view.beside)[1]}};
      render_view(*posed, view, flags_for(request_.flags, plan_, flags.scene, name), name,
                  std::move(moments));
    } catch (...) {
      handle_failure(1);
    }
    posed->forget_seconds();
  }
}

void RenderRun::render_view(PosedScene& posed, const View& view, const RenderFlags& flags,
                            const PictureName& name, std::optional<Moments> moments) {
  claim_files(flags);
  if (is_skipped(flags)) return;
  make_named_folders(flags, plan_.files);
  RenderRequest request = request_;
  request.flags = flags;
  const PictureContext context{command_line_, command_for(flags, view, name), place_in_run(), *write_now_,
                               std::move(moments)};
  const auto [code, is_stopped] = render_picture(request, posed, view, context, log_);
  ++rendered_;
  is_stopped_ = is_stopped;
  if (code == ExitCode::done || code == ExitCode::stopped)
    count_done(1);
  else
    fail(1, code);
}

void RenderRun::load_next(const std::vector<PictureName>& poses, size_t at) {
  // A picture that has a time to be rendered in has the machine to itself, and one thread is asked for to
  // leave the others alone.
  if (std::isfinite(request_.settings.limits.seconds) || thread_count() < 2) return;
  for (size_t next = at + 1; next < poses.size(); ++next)
    if (skipped_pictures(plan_.scenes[scene_], poses[next]).empty())
      return load_pose(loader_, scene_, poses[next], true);
  for (size_t scene = scene_ + 1; scene < plan_.scenes.size(); ++scene)
    if (load_scene(scene)) return;
  for (size_t scene = 0; next_run_ && scene < next_run_->plan_.scenes.size(); ++scene)
    if (next_run_->load_scene(scene)) return;
}

bool RenderRun::load_scene(size_t index) {
  const std::string& scene = plan_.scenes[index];
  const std::vector<PictureName> poses = poses_of(scene, plan_.variants);
  const auto is_missing = [&](const auto& name) { return skipped_pictures(scene, name).empty(); };
  const auto first = std::find_if(poses.begin(), poses.end(), is_missing);
  if (first == poses.end()) return false;
  next_scene_ = index;
  next_loader_ = std::make_shared<SceneLoader>(request_);
  load_pose(next_loader_, index, *first, poses.size() > 1);
  return true;
}

void RenderRun::load_pose(std::shared_ptr<SceneLoader> loader, size_t scene, const PictureName& name,
                          bool keeps_file) {
  const std::string file = plan_.scenes[scene];
  const bool is_known = name.variant != plan_.variants.front() || !plan_.all_variants;
  const auto load = [=, this](NoticeLog& log) -> std::unique_ptr<PosedScene> {
    prepare();
    if (keeps_file || shows_motion_ || !is_known) loader->open(file);
    return is_known ? loader->pose(flags_for(request_.flags, plan_, file, name), plan_, log) : nullptr;
  };
  resources_.ahead.start({std::move(loader), name.variant, name.frame}, file,
                         request_.flags.import.memory.bytes, load);
}

std::vector<RenderFlags> RenderRun::skipped_pictures(const std::string& scene, PictureName name) const {
  std::vector<RenderFlags> pictures;
  if (!request_.flags.run.skip_existing || plan_.all_cameras || !knows_names_without_scene(plan_)) return {};
  for (const auto& side : plan_.sides) {
    if (side) name.frame = side;
    pictures.push_back(flags_for(request_.flags, plan_, scene, name));
    if (!exists(pictures.back())) return {};
  }
  return pictures;
}

bool RenderRun::is_pose_skipped(const std::string& scene, const PictureName& name) {
  const std::vector<RenderFlags> pictures = skipped_pictures(scene, name);
  for (const RenderFlags& picture : pictures) is_skipped(picture);
  return !pictures.empty();
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
  const bool counts_frames = shows_motion_ || picture.import.shutter;
  if (counts_frames && picture.run.fps) instead["--fps"] = fmt::format("{}", *picture.run.fps);
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

PlaceInRun RenderRun::place_in_run() const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - place_.start;
  const size_t left =
      scene_pictures_ - std::min(scene_pictures_, scene_done_) + scenes_left_ * scene_pictures_;
  const size_t before = place_.pictures_before + done_;
  return {before + 1, before + std::max<size_t>(left, 1) + place_.pictures_after,
          place_.rendered_before + rendered_, elapsed.count()};
}

}  // namespace vernier::apps
