// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/run_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "apps/vernier/checkpointing.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/frame_list.h"
#include "apps/vernier/picture_output.h"
#include "core/base/atomic_file.h"
#include "core/image/image_io.h"
#include "integrators/render/layers.h"

namespace vernier::apps {
namespace {

constexpr const char* all = "all";
constexpr double default_fps = 24;

std::optional<FilePattern> optional_pattern(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(FilePattern(text));
}

FilePatterns read_patterns(const RenderFlags& flags) {
  FilePatterns files;
  for (const std::string& output : flags.outputs) files.outputs.emplace_back(output);
  files.stats = optional_pattern(flags.stats);
  files.report = optional_pattern(flags.report);
  files.checkpoint = optional_pattern(flags.checkpoint);
  files.resume = optional_pattern(flags.resume);
  return files;
}

std::vector<std::optional<int>> turntable_sides(const RunFlags& flags) {
  std::vector<std::optional<int>> sides;
  if (flags.frames.empty()) {
    for (int side = 1; side <= *flags.turntable; ++side) sides.emplace_back(side);
    return sides;
  }
  for (const int side : parse_frames(flags.frames)) {
    if (side < 1 || side > *flags.turntable)
      throw Error(ErrorKind::usage, fmt::format("--frames: a turntable of {0} has pictures 1 to {0}, not {1}",
                                                *flags.turntable, side));
    sides.emplace_back(side);
  }
  return sides;
}

/// What there may be several of, which a placeholder then tells apart.
struct Several {
  Placeholder placeholder;
  bool is_several;
  std::string what;
};

std::vector<Several> several(const RunPlan& plan) {
  const size_t frames = std::max(plan.times.size(), plan.sides.size());
  return {{Placeholder::name, plan.scenes.size() > 1, fmt::format("{} scenes", plan.scenes.size())},
          {Placeholder::variant, plan.all_variants, "all variants"},
          {Placeholder::camera, plan.all_cameras, "all cameras"},
          {Placeholder::frame, frames > 1, fmt::format("{} frames", frames)}};
}

void require_placeholders(const RunPlan& plan, const FilePattern& pattern) {
  for (const auto& [placeholder, is_several, what] : several(plan)) {
    if (!is_several || pattern.has(placeholder)) continue;
    if (is_standard_stream(pattern.text()))
      throw Error(ErrorKind::usage, fmt::format("-o - takes one picture; {} need files of their own", what));
    const bool frame = placeholder == Placeholder::frame;
    throw Error(ErrorKind::usage, pattern.text(), {},
                fmt::format("{} would be written over each other; put {}{} into the name", what,
                            text_of(placeholder), frame ? " or ####" : ""));
  }
}

void refuse_empty_placeholders(const RunPlan& plan, const FilePattern& pattern) {
  if (pattern.has(Placeholder::frame) && !plan.times[0] && !plan.sides[0])
    throw Error(ErrorKind::usage, pattern.text(), {},
                "{frame} or #### stands for the number of a frame and there are none; --frames or "
                "--turntable gives some");
  if (pattern.has(Placeholder::variant) && !plan.all_variants && plan.variants[0].empty())
    throw Error(ErrorKind::usage, pattern.text(), {},
                "{variant} stands for a variant of the materials and none is asked for; --variant NAME or "
                "--variant all does");
}

void require_different_stems(const RunPlan& plan) {
  std::map<std::string, std::string> scenes;
  for (const std::string& scene : plan.scenes)
    if (const auto [other, is_new] = scenes.try_emplace(stem_of(scene), scene); !is_new)
      throw Error(
          ErrorKind::usage, scene, {},
          fmt::format("would be rendered over {}, since {{name}} is '{}' for both; render them in two "
                      "runs",
                      other->second == scene ? "itself" : other->second, stem_of(scene)));
}

template <typename Visit>
void for_each_pattern(const FilePatterns& files, const Visit& visit) {
  for (const FilePattern& output : files.outputs) visit(output);
  for (const auto* pattern : {&files.stats, &files.report, &files.checkpoint, &files.resume})
    if (*pattern) visit(**pattern);
}

/// Calls visit(flags) for each picture as far as it is known before the scenes are read.
template <typename Visit>
void for_each_picture(const RenderFlags& flags, const RunPlan& plan, const Visit& visit) {
  for (const std::string& scene : plan.scenes)
    for (const std::string& variant : plan.variants)
      for (const auto time : plan.times)
        for (const auto side : plan.sides)
          visit(flags_for(flags, plan, scene, {stem_of(scene), "camera", variant, time ? time : side}));
}

/// Whatever a placeholder names a folder after is made when its picture's turn comes.
void check_writable_files(const RenderFlags& picture, const FilePatterns& files) {
  for (size_t i = 0; i < picture.outputs.size(); ++i)
    check_output(picture.outputs[i], files.outputs[i].names_folder());
  const auto check = [](const std::optional<FilePattern>& pattern, const std::string& file) {
    if (pattern && !pattern->names_folder()) check_writable(file);
  };
  check(files.stats, picture.stats);
  check(files.report, picture.report);
  check(files.checkpoint, picture.checkpoint);
}

/// Hours may pass until a scene's turn comes.
void require_scenes(const RunPlan& plan) {
  for (const std::string& scene : plan.scenes)
    if (!is_standard_stream(scene)) require_readable(scene);
}

}  // namespace

bool shows_motion(const RenderFlags& flags) {
  const std::vector<Layer> chosen = find_layers(flags.layers);
  return std::any_of(chosen.begin(), chosen.end(),
                     [](const Layer& l) { return l.need == LayerNeed::motion; });
}

double frame_seconds(const RunFlags& flags) { return 1 / flags.fps.value_or(default_fps); }

RunPlan make_plan(const RenderFlags& flags) {
  check_run_flags(flags.run, {flags.import.time.has_value(), shows_motion(flags)});
  RunPlan plan;
  plan.scenes = flags.run.scenes;
  plan.all_variants = flags.import.variant == all;
  plan.variants = {flags.import.variant};
  plan.all_cameras = flags.camera.camera == all;
  if (flags.run.turntable) {
    if (flags.camera.panorama)
      throw Error(ErrorKind::usage, "--panorama sees all around already; drop it or --turntable");
    plan.sides = turntable_sides(flags.run);
    plan.sides_around = *flags.run.turntable;
  } else if (!flags.run.frames.empty()) {
    plan.times.clear();
    for (const int frame : parse_frames(flags.run.frames)) plan.times.emplace_back(frame);
  }
  plan.files = read_patterns(flags);
  for_each_pattern(plan.files, [&](const FilePattern& pattern) {
    refuse_empty_placeholders(plan, pattern);
    require_placeholders(plan, pattern);
  });
  if (plan.scenes.size() > 1) require_different_stems(plan);
  return plan;
}

RenderFlags flags_for(const RenderFlags& flags, const RunPlan& plan, const std::string& scene,
                      const PictureName& picture) {
  RenderFlags one = flags;
  one.scene = scene;
  one.import.variant = picture.variant;
  one.import.shutter = shutter_of(flags.run.shutter, frame_seconds(flags.run));
  if (plan.times[0] && picture.frame)
    one.import.time = frame_time(*picture.frame, flags.run.fps.value_or(default_fps));
  for (size_t i = 0; i < one.outputs.size(); ++i) one.outputs[i] = plan.files.outputs[i].fill(picture);
  const auto fill = [&](const std::optional<FilePattern>& pattern, std::string& file) {
    if (pattern) file = pattern->fill(picture);
  };
  fill(plan.files.stats, one.stats);
  fill(plan.files.report, one.report);
  fill(plan.files.checkpoint, one.checkpoint);
  fill(plan.files.resume, one.resume);
  return one;
}

std::vector<std::string> files_read(const RenderFlags& flags, const RunPlan& plan) {
  std::vector<std::string> read = plan.scenes;
  read.insert(read.end(), {flags.surroundings.environment, flags.display.config, flags.background.file()});
  for_each_picture(flags, plan, [&](const RenderFlags& picture) {
    if (picture.resume != picture.checkpoint) read.push_back(picture.resume);
  });
  return read;
}

std::vector<std::string> files_written(const RenderFlags& flags, const RunPlan& plan) {
  std::vector<std::string> written;
  for_each_picture(flags, plan, [&](const RenderFlags& picture) {
    written.insert(written.end(), picture.outputs.begin(), picture.outputs.end());
    written.insert(written.end(), {picture.stats, picture.report, picture.checkpoint});
  });
  return written;
}

void check_files(const RenderFlags& flags, const RunPlan& plan) {
  require_separate_files(files_read(flags, plan), files_written(flags, plan));
  if (!flags.run.keep_going) require_scenes(plan);
  for_each_picture(flags, plan, [&](const RenderFlags& picture) {
    check_writable_files(picture, plan.files);
    require_resumable(picture);
  });
}

}  // namespace vernier::apps
