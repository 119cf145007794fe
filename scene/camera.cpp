// SPDX-License-Identifier: Apache-2.0
#include "scene/camera.h"

namespace vernier {

Camera::Camera(const CameraDescription& d, int width, int height)
    : kind_(d.kind),
      origin_(d.to_world.origin),
      width_(float(width)),
      height_(float(height)),
      lens_radius_(d.lens_radius),
      inverse_focus_(1 / d.focus_distance) {
  // Scale and shear of a camera's node do not count (glTF 2.0, 3.10.2): only where it is and where it looks.
  back_ = normalize(d.to_world.z);
  right_ = normalize(cross(d.to_world.y, back_));
  up_ = cross(back_, right_);
  const float vertical = kind_ == CameraDescription::Kind::perspective ? std::tan(d.yfov / 2) : d.ymag;
  half_extent_ = {vertical * width_ / height_, vertical};
}

Vec2f Camera::on_image_plane(const Vec2f& raster) const {
  return {(2 * raster.x / width_ - 1) * half_extent_.x, (1 - 2 * raster.y / height_) * half_extent_.y};
}

/// Positions beyond a pole go on on its other side, as a filter that reaches there wants.
Vec3f Camera::panorama_direction(const Vec2f& raster) const {
  const float azimuth = 2 * pi * (raster.x / width_ - 0.5f), from_up = pi * raster.y / height_;
  const float across = std::sin(from_up);
  return right_ * (std::cos(azimuth) * across) + up_ * std::cos(from_up) +
         back_ * (std::sin(azimuth) * across);
}

Ray Camera::ray(const Vec2f& raster) const {
  const auto [x, y] = on_image_plane(raster);
  Ray ray;
  ray.origin = origin_;
  switch (kind_) {
    case CameraDescription::Kind::perspective:
      ray.direction = normalize(right_ * x + up_ * y - back_);
      break;
    case CameraDescription::Kind::orthographic:
      ray.origin = origin_ + right_ * x + up_ * y;
      ray.direction = -back_;
      break;
    case CameraDescription::Kind::panorama:
      ray.direction = normalize(panorama_direction(raster));
      break;
  }
  return ray;
}

Ray Camera::ray(const Vec2f& raster, const Vec2f& on_lens) const {
  const Vec2f at = on_image_plane(raster), shift = on_lens * lens_radius_;
  // The point in focus, seen from `shift`, over its distance: this holds for infinite ones too.
  const Vec2f slope = at - shift * inverse_focus_;
  Ray ray;
  ray.origin = origin_ + right_ * shift.x + up_ * shift.y;
  ray.direction = normalize(right_ * slope.x + up_ * slope.y - back_);
  return ray;
}

float Camera::depth(const Ray& ray, float t) const {
  return kind_ == CameraDescription::Kind::panorama ? t : -t * dot(ray.direction, back_);
}

std::optional<Camera::Sight> Camera::sight(const Vec3f& world, const Vec2f& on_lens) const {
  const Vec2f shift = on_lens * lens_radius_;
  Sight sight{lens_radius_ > 0 ? origin_ + right_ * shift.x + up_ * shift.y : origin_, {0, 0}, 0};
  const Vec3f d = world - sight.origin;
  if (kind_ == CameraDescription::Kind::panorama) {
    const float distance2 = length_squared(d);
    if (!(distance2 > 0)) return std::nullopt;
    const float ahead = dot(d, right_), aside = dot(d, back_), across = std::hypot(ahead, aside);
    const float u = std::atan2(aside, ahead) * (inv_pi / 2) + 0.5f;
    const float v = std::atan2(across, dot(d, up_)) * inv_pi;
    sight.raster = {u * width_, v * height_};
    sight.area = width_ * height_ * square(inv_pi) / (2 * across * std::sqrt(distance2));
    return sight;
  }
  const float depth = -dot(d, back_);
  if (!(depth > 0)) return std::nullopt;
  const bool is_perspective = kind_ == CameraDescription::Kind::perspective;
  const float scale = is_perspective ? 1 / depth : 1;
  // What is in focus stays in its place whatever the point of the opening.
  const float x = (dot(d, right_) * scale + shift.x * inverse_focus_) / half_extent_.x;
  const float y = (dot(d, up_) * scale + shift.y * inverse_focus_) / half_extent_.y;
  sight.raster = {(x + 1) / 2 * width_, (1 - y) / 2 * height_};
  sight.area = width_ * height_ / (4 * half_extent_.x * half_extent_.y);
  if (is_perspective)
    sight.area *= length(d) / (square(depth) * depth);  // 1 / (z^2 cos)
  else
    sight.origin = world + back_ * depth;
  return sight;
}

std::optional<Vec2f> Camera::project(const Vec3f& world) const {
  const auto seen = sight(world, {0, 0});
  return seen ? std::optional(seen->raster) : std::nullopt;
}

}  // namespace vernier
