// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/vernier/file_pattern.h"
#include "apps/vernier/render_flags.h"

namespace vernier::apps {

/// The files that a render may write or go on from.
struct FilePatterns {
  std::vector<FilePattern> outputs;
  std::optional<FilePattern> stats, report, checkpoint, resume;
};

/// Which pictures a run makes: every scene in every variant, at every time, by every camera and from every
/// side that was asked for.
struct RunPlan {
  std::vector<std::string> scenes;
  std::vector<std::string> variants;  ///< one empty: the materials that the file has without
  bool all_variants = false;          ///< of each scene, instead
  bool all_cameras = false;           ///< of each scene
  std::vector<std::optional<int>> times{std::nullopt};  ///< frames of an animation; one without: --at or rest
  std::vector<std::optional<int>> sides{std::nullopt};  ///< pictures of a turntable; one without: none
  int sides_around = 1;                                 ///< pictures of a whole turn
  FilePatterns files;
};

/// Whether the pictures are compared with those before and after them. Throws Error(usage) on an unknown
/// layer.
bool shows_motion(const RenderFlags& flags);
/// From one picture of an animation to the next.
double frame_seconds(const RunFlags& flags);

/// Throws Error(usage) when the flags contradict each other, when a placeholder has nothing to stand for, and
/// when two pictures would be written to one file.
RunPlan make_plan(const RenderFlags& flags);

/// The flags of one picture by itself: patterns filled in, scene, variant and time chosen.
RenderFlags flags_for(const RenderFlags& all, const RunPlan& plan, const std::string& scene,
                      const PictureName& picture);

/// What the run reads, and what it writes, as far as names are known before the scenes are read.
std::vector<std::string> files_read(const RenderFlags& flags, const RunPlan& plan);
std::vector<std::string> files_written(const RenderFlags& flags, const RunPlan& plan);

/// Throws Error when a file cannot be written, would be written over one that is read, or is not there to go
/// on from; as far as names are known.
void check_files(const RenderFlags& flags, const RunPlan& plan);

}  // namespace vernier::apps
