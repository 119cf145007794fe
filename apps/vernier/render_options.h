// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/vernier/render_flags.h"
#include "apps/vernier/render_memory.h"
#include "core/base/quantities.h"
#include "core/denoise/denoise.h"
#include "core/display/display.h"
#include "integrators/integrator.h"
#include "integrators/render/layers.h"
#include "integrators/render/picture.h"
#include "vernier/scene.h"

namespace vernier::apps {

enum class ProgressMode { automatic, bar, lines, json, none };

/// The flags after everything that can be checked without reading a scene has been checked.
struct RenderRequest {
  RenderFlags flags;
  RenderSettings settings;  ///< width 0: not given; the camera is not known yet
  ProgressMode progress = ProgressMode::automatic;
  std::string layer_list;  ///< as --aov takes it, with what denoising needs
  std::vector<Layer> layers;
  const Denoiser* denoiser = nullptr;  ///< null: none
  DisplayOptions display;
  std::optional<Surroundings> surroundings;  ///< none: left to the scene, or not read yet
  double check_seconds = 0;                  ///< that all of this took
};

/// Checks names and sizes, and decodes nothing. Files: run_plan.h. Throws Error.
RenderRequest check_render_flags(const RenderFlags& flags);

/// Whether a .png or .jpg is among the outputs.
bool has_display_output(const RenderFlags& flags);

MemoryUse memory_use(const RenderRequest& request);

}  // namespace vernier::apps
