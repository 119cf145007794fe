// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "apps/vernier/lens.h"
#include "apps/vernier/notice_log.h"
#include "apps/vernier/render_options.h"
#include "apps/vernier/scene_summary.h"
#include "core/image/image_io.h"
#include "integrators/render/picture.h"
#include "integrators/render/settings_identity.h"
#include "scene/accel/accelerator.h"

namespace vernier::apps {

/// What is known of a render when its image is written.
struct RenderReport {
  std::string command_line;     ///< as typed
  std::string picture_command;  ///< that makes this picture alone
  std::string scene_file, scene_hash, camera, accelerator;
  std::optional<Lens> lens;  ///< none: a pinhole
  Surroundings surroundings{"none", nullptr};
  SceneCounts counts;
  AcceleratorStats accelerator_stats;
  RenderSettings settings;
  size_t texture_mip_bytes = 0;  ///< of copies made for the texture filter
  unsigned threads = 0;
  std::string kept;                ///< checkpoint, where no picture is asked for
  std::vector<std::string> files;  ///< pictures that have been written
  double load_seconds = 0;         ///< reading the scene and the environment
  double build_seconds = 0;        ///< from the description to a scene that answers rays
  double output_seconds = 0;       ///< display transform, encoding, writing
};

/// When rendering is to end, as in the --stats file.
nlohmann::ordered_json asked_json(const RenderSettings& settings);

/// "samples", "time", "error" or "interrupted".
std::string_view name_of(StopReason reason);

/// Image header entries that say how the picture came about.
Metadata image_metadata(const RenderReport& report, const RenderFlags& flags, const RenderResult& result);

/// ", error 1.02 % (1.01 to 1.03 %)"; empty while it is not known.
std::string error_text(const ErrorEstimate& error);

/// The content of the --stats file; docs/stats.md documents every field.
nlohmann::ordered_json stats_json(const RenderReport& report, const RenderFlags& flags,
                                  const RenderResult& result, const NoticeLog& log);

/// What --verbose says before rendering.
std::string scene_lines(const RenderReport& report);

/// "wrote out.exr: 1280x720, 64 spp, load 310 ms, build 100 ms, render 12.3 s, 5.10 M rays/s"
std::string summary_line(const RenderReport& report, const RenderResult& result);

}  // namespace vernier::apps
