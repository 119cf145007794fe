// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/vernier/background_flags.h"
#include "apps/vernier/camera_flags.h"
#include "apps/vernier/commands.h"
#include "apps/vernier/run_flags.h"
#include "apps/vernier/surroundings.h"
#include "core/display/display.h"
#include "core/image/image_io.h"
#include "integrators/integrator.h"
#include "vernier/scene.h"

namespace vernier::apps {

/// The flags of `vernier render`, as typed.
struct RenderFlags {
  std::string scene;  ///< of one picture; RunFlags has them all
  ImportOptions import;
  std::vector<std::string> outputs;

  std::string integrator = "path";
  std::string show;  ///< empty: not given
  IntegratorOptions integrator_options;
  std::string accelerator;

  std::optional<int> spp;
  std::string time, error, size, crop;
  std::string filter = "box";
  std::string texture_filter;  ///< empty: not given
  std::string adaptive = "on";
  std::string caustics = "auto";
  uint64_t seed = 0;
  unsigned threads = 0;

  CameraFlags camera;
  SurroundingsFlags surroundings;
  BackgroundFlags background;
  std::string fog;  ///< as typed; empty: none

  std::string layers;  ///< --aov; empty: none
  std::vector<std::string> light_groups;
  std::string denoise;  ///< filter; empty: none
  DisplayOptions display;
  ExrOptions exr;
  std::string progress = "auto";
  std::string stats, report;
  std::string checkpoint, resume;  ///< files; empty: none
  std::string checkpoint_every = "5m";
  bool drop_checkpoint = false;
  bool quiet = false, verbose = false;

  RunFlags run;
};

/// Declares the flags on `command`.
void add_render_flags(CLI::App& command, RenderFlags& flags);

/// Parts of them, for other commands. All that says what a picture shows and how well, but for what is done
/// with it.
void add_picture_flags(CLI::App& command, RenderFlags& flags);
void add_denoise_flag(CLI::App& command, RenderFlags& flags);
/// How samples are spread and how long paths are.
void add_adaptive_flag(CLI::App& command, RenderFlags& flags);
void add_max_depth_flag(CLI::App& command, RenderFlags& flags);

/// Prints the list that a flag given as "help" asks for; false when none was.
bool print_requested_list(const RenderFlags& flags);

}  // namespace vernier::apps
