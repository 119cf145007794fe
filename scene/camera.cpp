// SPDX-License-Identifier: Apache-2.0
#include "scene/camera.h"

#include <ImathMatrixAlgo.h>

#include "core/math/moments.h"

namespace vernier {

Camera::Camera(const CameraDescription& d, int width, int height)
    : kind_(d.kind),
      place_(place_of(d.to_world)),
      width_(float(width)),
      height_(float(height)),
      lens_radius_(d.lens_radius),
      inverse_focus_(1 / d.focus_distance) {
  const float vertical = kind_ == CameraDescription::Kind::perspective ? std::tan(d.yfov / 2) : d.ymag;
  half_extent_ = {vertical * width_ / height_, vertical};
  for (const Transform& to_world : d.moments) {
    const auto [origin, right, up, back] = place_of(to_world);
    const Imath::M44f axes(right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, back.x, back.y, back.z, 0, 0, 0,
                           0, 1);
    Moment moment{origin, Imath::extractQuat(axes).normalized()};
    if (moves() && (moment.rotation ^ moments_.back().rotation) < 0) moment.rotation = -moment.rotation;
    moments_.push_back(moment);
  }
}

/// Scale and shear of a camera's node do not count (glTF 2.0, 3.10.2): only where it is and where it looks.
Camera::Place Camera::place_of(const Transform& to_world) {
  const Vec3f back = normalize(to_world.z);
  const Vec3f right = normalize(cross(to_world.y, back));
  return {to_world.origin, right, cross(back, right), back};
}

/// Turns at constant speed from one moment to the next (Shoemake 1985, "Animating Rotation with Quaternion
/// Curves").
Camera::Place Camera::place_at(float time) const {
  if (!moves()) return place_;
  const auto [first, part] = moments_around(time, moments_.size());
  const Moment &from = moments_[first], &to = moments_[first + 1];
  const Imath::M33f axes = Imath::slerp(from.rotation, to.rotation, part).toMatrix33();
  const auto axis = [&](int i) { return Vec3f(axes[i][0], axes[i][1], axes[i][2]); };
  return {between(from.origin, to.origin, part), axis(0), axis(1), axis(2)};
}

Vec2f Camera::on_image_plane(const Vec2f& raster) const {
  return {(2 * raster.x / width_ - 1) * half_extent_.x, (1 - 2 * raster.y / height_) * half_extent_.y};
}

Ray Camera::ray(const Vec2f& raster) const { return ray(place_, raster); }
Ray Camera::ray(const Vec2f& raster, const Vec2f& on_lens) const { return ray(place_, raster, on_lens); }

Ray Camera::ray(const Vec2f& raster, const std::optional<Vec2f>& on_lens, float time) const {
  const Place place = place_at(time);
  Ray result = on_lens ? ray(place, raster, *on_lens) : ray(place, raster);
  result.time = time;
  return result;
}

Ray Camera::ray(const Place& place, const Vec2f& raster) const {
  const auto& [origin, right, up, back] = place;
  const auto [x, y] = on_image_plane(raster);
  Ray ray;
  ray.origin = origin;
  switch (kind_) {
    case CameraDescription::Kind::perspective:
      ray.direction = normalize(right * x + up * y - back);
      break;
    case CameraDescription::Kind::orthographic:
      ray.origin = origin + right * x + up * y;
      ray.direction = -back;
      break;
    case CameraDescription::Kind::panorama: {
      // Positions beyond a pole go on on its other side, as a filter that reaches there wants.
      const float azimuth = 2 * pi * (raster.x / width_ - 0.5f), from_up = pi * raster.y / height_;
      const float across = std::sin(from_up);
      ray.direction = normalize(right * (std::cos(azimuth) * across) + up * std::cos(from_up) +
                                back * (std::sin(azimuth) * across));
      break;
    }
  }
  return ray;
}

Ray Camera::ray(const Place& place, const Vec2f& raster, const Vec2f& on_lens) const {
  const Vec2f at = on_image_plane(raster), shift = on_lens * lens_radius_;
  // The point in focus, seen from `shift`, over its distance: this holds for infinite ones too.
  const Vec2f slope = at - shift * inverse_focus_;
  Ray ray;
  ray.origin = place.origin + place.right * shift.x + place.up * shift.y;
  ray.direction = normalize(place.right * slope.x + place.up * slope.y - place.back);
  return ray;
}

RayCone Camera::pixel_cone(const Vec2f& raster) const {
  if (kind_ == CameraDescription::Kind::panorama) {
    const float across = std::abs(std::sin(pi * raster.y / height_));
    return {0, pi * std::sqrt(2 * across / (width_ * height_))};
  }
  const float side = 2 * std::sqrt(half_extent_.x * half_extent_.y / (width_ * height_));
  if (kind_ == CameraDescription::Kind::orthographic) return {side, 0};
  // A pixel on the image plane, which is farther away than 1 and seen from the side.
  const float cosine2 = 1 / (1 + on_image_plane(raster).length2());
  return {0, side * std::pow(cosine2, 0.75f)};
}

float Camera::depth(const Ray& ray, float t) const {
  return kind_ == CameraDescription::Kind::panorama ? t : -t * dot(ray.direction, place_.back);
}

std::optional<Camera::Sight> Camera::sight(const Place& place, const Vec3f& world,
                                           const Vec2f& on_lens) const {
  const Vec2f shift = on_lens * lens_radius_;
  Sight sight{
      lens_radius_ > 0 ? place.origin + place.right * shift.x + place.up * shift.y : place.origin, {0, 0}, 0};
  const Vec3f d = world - sight.origin;
  if (kind_ == CameraDescription::Kind::panorama) {
    const float distance2 = length_squared(d);
    if (!(distance2 > 0)) return std::nullopt;
    const float ahead = dot(d, place.right), aside = dot(d, place.back), across = std::hypot(ahead, aside);
    const float u = std::atan2(aside, ahead) * (inv_pi / 2) + 0.5f;
    const float v = std::atan2(across, dot(d, place.up)) * inv_pi;
    sight.raster = {u * width_, v * height_};
    sight.area = width_ * height_ * square(inv_pi) / (2 * across * std::sqrt(distance2));
    return sight;
  }
  const float depth = -dot(d, place.back);
  if (!(depth > 0)) return std::nullopt;
  const bool is_perspective = kind_ == CameraDescription::Kind::perspective;
  const float scale = is_perspective ? 1 / depth : 1;
  // What is in focus stays in its place whatever the point of the opening.
  const float x = (dot(d, place.right) * scale + shift.x * inverse_focus_) / half_extent_.x;
  const float y = (dot(d, place.up) * scale + shift.y * inverse_focus_) / half_extent_.y;
  sight.raster = {(x + 1) / 2 * width_, (1 - y) / 2 * height_};
  sight.area = width_ * height_ / (4 * half_extent_.x * half_extent_.y);
  if (is_perspective)
    sight.area *= length(d) / (square(depth) * depth);  // 1 / (z^2 cos)
  else
    sight.origin = world + place.back * depth;
  return sight;
}

std::optional<Camera::Sight> Camera::sight(const Vec3f& world, const Vec2f& on_lens, float time) const {
  return sight(place_at(time), world, on_lens);
}

std::optional<Vec2f> Camera::project(const Vec3f& world) const {
  const auto seen = sight(place_, world, {0, 0});
  return seen ? std::optional(seen->raster) : std::nullopt;
}

}  // namespace vernier
