// SPDX-License-Identifier: Apache-2.0
#include "scene/camera.h"

namespace vernier {

Camera::Camera(const CameraDescription& d, int width, int height)
    : kind_(d.kind), origin_(d.to_world.origin), width_(float(width)), height_(float(height)) {
  // Scale and shear of a camera's node do not count (glTF 2.0, 3.10.2): only where it is and where it looks.
  back_ = normalize(d.to_world.z);
  right_ = normalize(cross(d.to_world.y, back_));
  up_ = cross(back_, right_);
  const float vertical = kind_ == CameraDescription::Kind::perspective ? std::tan(d.yfov / 2) : d.ymag;
  half_extent_ = {vertical * width_ / height_, vertical};
}

Ray Camera::ray(const Vec2f& raster) const {
  const float x = (2 * raster.x / width_ - 1) * half_extent_.x;
  const float y = (1 - 2 * raster.y / height_) * half_extent_.y;
  Ray ray;
  if (kind_ == CameraDescription::Kind::perspective) {
    ray.origin = origin_;
    ray.direction = normalize(right_ * x + up_ * y - back_);
  } else {
    ray.origin = origin_ + right_ * x + up_ * y;
    ray.direction = -back_;
  }
  return ray;
}

std::optional<Vec2f> Camera::project(const Vec3f& world) const {
  const Vec3f d = world - origin_;
  const float depth = -dot(d, back_);
  if (!(depth > 0)) return std::nullopt;
  const float scale = kind_ == CameraDescription::Kind::perspective ? 1 / depth : 1;
  const float x = dot(d, right_) * scale / half_extent_.x, y = dot(d, up_) * scale / half_extent_.y;
  return Vec2f((x + 1) / 2 * width_, (1 - y) / 2 * height_);
}

}  // namespace vernier
