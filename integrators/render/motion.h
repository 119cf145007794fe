// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "scene/camera.h"
#include "scene/scene.h"
#include "vernier/session.h"

namespace vernier {

/// Where what a pixel shows is in the pictures before and after, less where it is in this one. Pixels, x to
/// the right, y up.
struct PixelMotion {
  Vec2f to_previous{0, 0}, to_next{0, 0};
};

/// Compares what a picture shows with where it is at two other moments.
class MotionFinder {
 public:
  /// `camera` is the picture's, `width` and `height` its size. The arguments must live as long.
  MotionFinder(const Scene& scene, const Camera& camera, const Moments& moments, int width, int height);

  /// Of a surface point of the scene. What another moment does not show, since it is behind its camera or
  /// was made of other triangles, counts as if it stood still.
  PixelMotion at(const TriangleId& triangle, const Vec2f& barycentrics) const;

 private:
  struct Other {
    const SceneGeometry& geometry;
    Camera camera;
  };
  Vec2f motion_to(const Other& other, const TriangleId& triangle, const Vec2f& barycentrics,
                  const Vec2f& here) const;

  const SceneGeometry& geometry_;
  const Camera& camera_;
  const Other previous_, next_;
};

}  // namespace vernier
