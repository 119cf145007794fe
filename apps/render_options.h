#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "core/base/quantities.h"
#include "core/image/denoise.h"
#include "core/image/display.h"
#include "integrators/integrator.h"
#include "integrators/layers.h"
#include "integrators/render.h"
#include "scene/description.h"
#include "scene/import/import.h"

namespace vernier::apps {

enum class ProgressMode { automatic, bar, lines, json, none };

/// The flags of `vernier render`, as typed.
struct RenderFlags {
  std::string scene;
  ImportOptions import;
  std::vector<std::string> outputs;

  std::string integrator = "path";
  std::string show;  ///< empty: not given
  IntegratorOptions integrator_options;
  std::string accelerator;

  std::optional<int> spp;
  std::string time, error, size, crop;
  std::string adaptive = "on";
  uint64_t seed = 0;
  unsigned threads = 0;

  std::string camera;
  std::string environment;
  float environment_rotate = 0;  ///< degrees
  float environment_scale = 1;

  std::string layers;   ///< --aov; empty: none
  std::string denoise;  ///< filter; empty: none
  DisplayOptions display;
  std::string progress = "auto";
  std::string stats, report;
  std::string checkpoint, resume;  ///< files; empty: none
  std::string checkpoint_every = "5m";
  bool quiet = false, verbose = false;
};

/// The flags after everything that can be checked without reading a scene has been checked.
struct RenderRequest {
  RenderFlags flags;
  std::unique_ptr<Integrator> integrator;
  RenderOptions options;  ///< width 0: not given
  ProgressMode progress = ProgressMode::automatic;
  std::vector<Layer> layers;
  const Denoiser* denoiser = nullptr;  ///< null: none
  DisplayOptions display;
  std::shared_ptr<const EnvironmentDescription> environment;  ///< null: the scene's own
};

/// Declares the flags on `command`.
void add_render_flags(CLI::App& command, RenderFlags& flags);

/// The part of them that says what surrounds the scene.
void add_environment_flags(CLI::App& command, RenderFlags& flags);

/// Null: the scene's own. Throws Error.
std::shared_ptr<const EnvironmentDescription> read_environment(const RenderFlags& flags);

/// Puts surroundings, if any, in place of the scene's own, and notes if it had some.
void surround(SceneDescription& scene, std::shared_ptr<const EnvironmentDescription> environment);

/// Prints the list that a flag given as "help" asks for; false when none was.
bool print_requested_list(const RenderFlags& flags);

/// Checks names, sizes, outputs and reads the environment. Throws Error.
RenderRequest check_render_flags(const RenderFlags& flags);

/// Whether the crop lies in the picture, and the picture with its layers in memory. Throws Error(usage) or
/// Error(memory).
void check_picture_size(const RenderOptions& options, std::span<const Layer> layers);

/// Whether a file is written as display values (PNG, JPEG) rather than scene-linear ones (EXR). By extension.
bool is_display_file(const std::string& path);

}  // namespace vernier::apps
