// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/ray.h"
#include "core/math/rounding.h"
#include "vernier/math.h"

namespace vernier {

/// A point on the scene's surface, with what is known of its rounding error. The only place rays are offset.
/// Also a point inside a medium, where light is scattered: it belongs to no instance, and its normal and
/// error are zero.
struct SurfacePoint {
  Vec3f position;      ///< world, from barycentrics
  Vec3f error;         ///< bound on |position - the exact point of the triangle| per axis
  Vec3f ng;            ///< unit geometric normal of the triangle's front (counter-clockwise) side
  float t = 0;         ///< ray parameter of the hit
  float u = 0, v = 0;  ///< barycentrics of vertices 1 and 2
  uint32_t instance = 0, primitive = 0;
  bool front = true;               ///< met from the front side
  float time = middle_of_shutter;  ///< at which it is there, as Ray::time
  /// Metres, side of the square about the ray to it that it stands for (RayCone): textures of colors are
  /// averaged over what it covers of the surface. 0: the point alone.
  float footprint = 0;

  TriangleId triangle() const { return {instance, primitive}; }
  bool is_in_medium() const { return instance == TriangleId::none; }

  /// Ray leaving the surface along w (world, any length), free of self-intersection.
  Ray spawn(const Vec3f& w) const {
    Ray ray{offset_ray_origin(position, error, ng, w), 0, w};
    ray.origin_triangle = triangle();
    ray.time = time;
    return ray;
  }

  /// Segment to another point, on triangle `reached` if on any, both ends moved off their surfaces; t in
  /// (0, 1) covers it.
  Ray spawn_to(const Vec3f& target, const Vec3f& target_error, const Vec3f& target_normal,
               const TriangleId& reached = {}) const {
    const Vec3f rough = target - position;
    Ray ray = spawn(rough);
    ray.direction = offset_ray_origin(target, target_error, target_normal, -rough) - ray.origin;
    ray.t_max = 1;
    ray.target_triangle = reached;
    return ray;
  }
};

}  // namespace vernier
