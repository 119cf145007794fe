// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/math/ray.h"
#include "vernier/scene.h"

namespace vernier {

class Scene;

namespace apps {

/// The rays that a path tracer casts in a scene whose surfaces are all diffuse, by purpose, each in the order
/// it casts them.
struct PathRays {
  std::vector<Ray> primary, bounce, shadow;
};

/// About `paths` paths, one through each pixel of a picture of that size, by tiles, with up to `max_bounces`
/// bounces by the cosine and one shadow ray at each vertex where a light is above the horizon.
PathRays record_path_rays(const Scene& scene, const CameraDescription& view, size_t paths, int max_bounces);

}  // namespace apps
}  // namespace vernier
