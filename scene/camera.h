// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/math/ray.h"
#include "vernier/scene.h"

namespace vernier {

/// Pinhole or orthographic camera for a picture of width x height pixels. Raster x runs right, y down, (0,0)
/// the outer corner of the first pixel. The vertical extent is the description's; the horizontal follows the
/// picture's shape (square pixels).
class Camera {
 public:
  Camera(const CameraDescription& description, int width, int height);

  /// World ray through raster position `raster`, unit direction.
  Ray ray(const Vec2f& raster) const;

  /// Raster position of a world point; empty when it is not in front of the camera.
  std::optional<Vec2f> project(const Vec3f& world) const;

 private:
  CameraDescription::Kind kind_;
  Vec3f origin_, right_, up_, back_;  ///< orthonormal, world
  Vec2f half_extent_;                 ///< of the image plane: at unit distance, or in metres for orthographic
  float width_, height_;
};

}  // namespace vernier
