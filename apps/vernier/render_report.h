// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/vernier/notice_log.h"
#include "apps/vernier/profile.h"
#include "apps/vernier/render_options.h"
#include "apps/vernier/scene_summary.h"
#include "core/image/image_io.h"
#include "integrators/render/render.h"
#include "scene/accel/accelerator.h"

namespace vernier::apps {

/// What is known of a render when its image is written.
struct RenderReport {
  std::string command_line;
  std::string scene_file, scene_hash, camera, accelerator;
  Surroundings surroundings{"none", nullptr};
  SceneCounts counts;
  AcceleratorStats accelerator_stats;
  RenderSettings options;
  unsigned threads = 0;
  std::vector<std::string> files;    ///< pictures that have been written
  double load_seconds = 0;           ///< reading the scene and the environment
  double build_seconds = 0;          ///< from the description to a scene that answers rays
  double output_seconds = 0;         ///< display transform, encoding, writing
  std::vector<ProfilePart> profile;  ///< empty: not sampled
  size_t profile_samples = 0;
};

/// "640x360+10+20", as --crop takes it.
std::string crop_text(const Crop& crop);

/// Image header entries that say how the picture came about.
Metadata image_metadata(const RenderReport& report, const RenderFlags& flags, const RenderResult& result);

/// Those of them that say what was sampled, and how wrong it is.
Metadata result_metadata(const RenderResult& result);

/// ", error 1.02 % (1.01 to 1.03 %)"; empty while it is not known.
std::string error_text(const ErrorEstimate& error);

/// Samples a pixel, on average.
double samples_per_pixel(const RenderResult& result);

/// The content of the --stats file; docs/stats.md documents every field.
nlohmann::ordered_json stats_json(const RenderReport& report, const RenderFlags& flags,
                                  const RenderResult& result, const NoticeLog& log);

/// What --verbose says before rendering.
std::string scene_lines(const RenderReport& report);

/// "wrote out.exr: 1280x720, 64 spp, load 310 ms, build 100 ms, render 12.3 s, 5.10 M rays/s"
std::string summary_line(const RenderReport& report, const RenderResult& result);

}  // namespace vernier::apps
