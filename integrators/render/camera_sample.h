// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/sampling/sampler.h"
#include "scene/camera.h"

namespace vernier {

/// One camera sample of a picture: its ray, and the sampler with which the light along it is estimated.
struct CameraSample {
  Sampler sampler;
  Ray ray;
};

/// Sample `index` of one half of pixel (x, y) of a picture `width` pixels wide: a pure function, so that what
/// a sample saw can be asked again later.
inline CameraSample camera_sample(const Camera& camera, int width, int x, int y, int half, uint32_t index,
                                  uint64_t seed) {
  Sampler sampler(uint32_t(y) * uint32_t(width) + uint32_t(x), index, 2 * seed + uint64_t(half));
  const Vec2f in_pixel = sampler.next2();
  return {sampler, camera.ray({float(x) + in_pixel.x, float(y) + in_pixel.y})};
}

}  // namespace vernier
