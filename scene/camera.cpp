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

CameraDescription fitted_camera(const Bounds& bounds, float aspect) {
  CameraDescription camera;
  camera.name = "fitted";
  camera.yfov = 40 * pi / 180;
  // From the front right and a little above, as product pictures are taken: the sphere about the box fills
  // the view.
  const float half_angle = std::atan(std::tan(camera.yfov / 2) * std::min(1.f, aspect));
  const float radius = std::max(bounds.radius(), 1e-6f);
  const Vec3f center = bounds.empty() ? Vec3f(0, 0, 0) : bounds.center();
  const Vec3f back = normalize(Vec3f(0.5f, 0.35f, 1));
  const Vec3f right = normalize(cross(Vec3f(0, 1, 0), back));
  camera.to_world = {right, cross(back, right), back, center + back * (radius / std::sin(half_angle))};
  return camera;
}

}  // namespace vernier
