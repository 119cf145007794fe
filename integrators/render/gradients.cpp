// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/gradients.h"

#include <fmt/format.h>

#include "scene/scene.h"
#include "vernier/error.h"

namespace vernier {

void check_gradients(const Integrator& integrator, const Scene& scene, const RenderSettings& settings) {
  if (!integrator.wants_gradients()) return;
  const auto refuse_for = [](const char* problem) {
    throw Error(ErrorKind::usage,
                fmt::format("gradient-domain path tracing {}; the integrator path does", problem));
  };
  if (scene.volumes().scatter()) refuse_for("does not follow light that a medium scatters");
  if (settings.background.kind != Background::Kind::surroundings)
    refuse_for("does not keep what lies behind all surfaces apart");
  if (settings.integrator_options.light_sampling != LightSampling::mis)
    refuse_for("does not sample lights or BSDFs alone");
}

GradientSample neighbors_of(const CameraSampleId& id, const CameraSamples& samples, const Crop& part) {
  GradientSample sample;
  for (size_t i = 0; i < PixelNeighbors::count; ++i) {
    const int dx = PixelNeighbors::dx[i], dy = PixelNeighbors::dy[i];
    const int x = id.x + dx - part.x, y = id.y + dy - part.y;
    sample.active[i] = x >= 0 && x < part.width && y >= 0 && y < part.height;
    if (sample.active[i]) sample.rays[i] = samples.get(id, dx, dy).ray;
  }
  return sample;
}

}  // namespace vernier
