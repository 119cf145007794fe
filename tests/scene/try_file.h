// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"
#include "vernier/scene_file.h"

namespace vernier::test {

inline void trace_a_ray(SceneDescription description) {
  const Scene scene(std::move(description), {});
  Ray ray;
  ray.origin = {0.2f, 0.2f, 50};
  ray.direction = {0, 0, -1};
  if (const auto hit = scene.intersect(ray)) scene.shade(*hit, -ray.direction);
}

/// Builds the scene at rest and, where the file has any, moving and in its first variant.
inline void try_file(SceneFile& file) {
  trace_a_ray(file.describe());
  ImportOptions options;
  if (const auto variants = file.variants(); !variants.empty()) options.variant = variants.front();
  if (!file.animations().empty()) {
    options.time = 0.5;
    options.shutter = Shutter{0.25, 0.75};
  }
  if (options.time || !options.variant.empty()) trace_a_ray(file.describe(options));
}

}  // namespace vernier::test
