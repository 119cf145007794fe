// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/render_memory.h"

#include <algorithm>

#include "core/denoise/denoise.h"
#include "core/film/error_estimate.h"
#include "integrators/render/render_state.h"

namespace vernier::apps {
namespace {

constexpr size_t color = 3 * sizeof(float);  // an Image of three channels

size_t session_bytes(const MemoryUse& use) {
  return RenderState::bytes_per_pixel(use.adaptive, use.alpha, use.light_parts, use.splats, use.gradients) +
         (use.gradients ? Film::correction_bytes_per_pixel() : 0) + (use.background_picture ? color : 0);
}

size_t while_rendering(const MemoryUse& use) {
  const size_t planning = use.adaptive ? SamplePlan::planning_bytes_per_pixel() : 0;
  const size_t reconstruction = use.gradients ? GradientFilm::reconstruction_bytes_per_pixel() : 0;
  return session_bytes(use) + std::max({planning, reconstruction, estimate_error_bytes_per_pixel()});
}

size_t while_writing(const MemoryUse& use) {
  // The session could go on, so it keeps all that takes.
  size_t kept = session_bytes(use) + color + size_t(use.layer_channels + use.alpha) * sizeof(float);
  size_t peak = kept + (use.error_layers ? error_layers_bytes_per_pixel() : 0);
  if (use.denoise) {
    peak = std::max(peak, kept + denoise_bytes_per_pixel());
    kept += 2 * color;  // the denoised picture and its error
  }
  // The color alone, its eight-bit values, and the encoded file, whose buffer grows by doubling; alpha is put
  // beside a color that was there without.
  if (use.display) peak = std::max(peak, kept + (use.alpha ? 3 : 1) * color + 3 * 4 * sizeof(uint8_t));
  if (use.half)
    peak = std::max(peak, kept + 2 * color + size_t(use.layer_channels + use.alpha) * sizeof(float));
  // The film's picture, and a map of the errors before it is made smaller.
  if (use.report) peak = std::max(peak, kept + error_layers_bytes_per_pixel() + color + sizeof(float));
  return peak;
}

}  // namespace

size_t peak_bytes_per_pixel(const MemoryUse& use) {
  return std::max(while_rendering(use), while_writing(use));
}

}  // namespace vernier::apps
