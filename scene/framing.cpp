// SPDX-License-Identifier: Apache-2.0
#include "scene/framing.h"

#include "core/math/frame.h"
#include "scene/scene.h"
#include "scene/subject.h"

namespace vernier {
namespace {

/// From the front right and a little above, as product pictures are taken.
constexpr float default_azimuth = pi / 6, default_elevation = pi / 12;

/// From the scene's centre to the viewer.
Vec3f orbit_direction(float azimuth, float elevation) {
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

/// Straight up and down, the front of the scene stays at the bottom of the picture and at the top.
Vec3f orbit_up(float azimuth, float elevation) { return orbit_direction(azimuth, elevation + pi / 2); }

/// One side of the picture at a time: `across` is its direction in the world, `back` the way to the viewer.
/// A point p lies in the view of slope t from (center, distance) when |p.across - center| <= t (distance -
/// p.back), which is two half-planes in the plane of both.
struct Side {
  const FarthestPoint& farthest;
  Vec3d across, back;

  /// What half-planes of slope t touch: a is largest in across + t back, b in -across + t back.
  struct Touched {
    double a, b;            ///< those sums
    double a_back, b_back;  ///< how far back the points that were touched lie
  };
  Touched touch(double slope) const {
    const Vec3d a(farthest(Vec3f(across + back * slope))), b(farthest(Vec3f(back * slope - across)));
    return {dot(a, across + back * slope), dot(b, back * slope - across), dot(a, back), dot(b, back)};
  }

  /// Least distance from which a view of that slope holds everything.
  double distance(double slope) const {
    const Touched touched = touch(slope);
    return (touched.a + touched.b) / (2 * slope);
  }

  /// Where to stand so that there is as much room at one end as at the other. The slope that just holds the
  /// body from `distance` is the root of a(t) + b(t) - 2 t distance, which is convex and made of straight
  /// pieces, so that Newton's method ends at it after a few steps.
  double center(double distance, double slope) const {
    Touched touched = touch(slope);
    constexpr int most_steps = 32;
    for (int step = 0; step < most_steps; ++step) {
      const double slack = 2 * slope * distance - touched.a - touched.b;
      const double steepness = 2 * distance - touched.a_back - touched.b_back;
      if (std::abs(slack) <= 1e-9 * std::abs(slope * distance) || !(steepness > 0)) break;
      slope = std::max(0.0, slope - slack / steepness);
      touched = touch(slope);
    }
    return (touched.a - touched.b) / 2;
  }
};

/// How far apart the body's ends are along a direction, and the middle between them.
struct Extent {
  double lower, upper;

  double size() const { return upper - lower; }
  double middle() const { return (upper + lower) / 2; }
};

Extent extent(const FarthestPoint& farthest, const Vec3d& axis) {
  return {dot(Vec3d(farthest(Vec3f(-axis))), axis), dot(Vec3d(farthest(Vec3f(axis))), axis)};
}

}  // namespace

CameraDescription fit_camera(CameraDescription camera, const FarthestPoint& farthest, float aspect,
                             float margin) {
  const Vec3d back = normalize(Vec3d(camera.to_world.z));
  const Vec3d right = normalize(cross(Vec3d(camera.to_world.y), back)), up = cross(back, right);
  const Extent depth = extent(farthest, back), width = extent(farthest, right), height = extent(farthest, up);
  // A body that is a point, or is seen end on, still has the camera in front of it.
  const double size = std::max({depth.size(), width.size(), height.size(), 1e-6});
  const double far_off =
      std::max({std::abs(depth.upper), std::abs(width.middle()), std::abs(height.middle())});
  // Far from the origin it cannot be placed closer than by a few steps of single precision.
  const double nearest = depth.upper + std::max(0.01 * size, 1e-6 * far_off);
  const double filled = 1 - 2.0 * margin;
  double x = width.middle(), y = height.middle(), z = nearest + size;
  if (camera.kind == CameraDescription::Kind::orthographic) {
    const double half = std::max({height.size(), width.size() / aspect, 1e-3 * size}) / 2;
    camera.ymag = float(half / filled);
    camera.xmag = camera.ymag * aspect;
  } else {
    const double slope = filled * std::tan(double(camera.yfov) / 2);
    const Side across{farthest, right, back}, upright{farthest, up, back};
    z = std::max({across.distance(slope * aspect), upright.distance(slope), nearest});
    x = across.center(z, slope * aspect);
    y = upright.center(z, slope);
  }
  camera.to_world = {Vec3f(right), Vec3f(up), Vec3f(back), Vec3f(right * x + up * y + back * z)};
  return camera;
}

void turn(CameraDescription& camera, const Vec3f& back, const Vec3f& up) {
  // About back, the x axis of this frame lies toward up.
  const Frame frame = Frame::from_normal_tangent(back, up);
  camera.to_world.x = -frame.y;
  camera.to_world.y = frame.x;
  camera.to_world.z = back;
}

void roll(CameraDescription& camera, float angle) {
  if (angle == 0) return;
  const auto roll_frame = [&](Transform& place) {
    const Vec3f back = normalize(place.z), right = normalize(cross(place.y, back)), up = cross(back, right);
    place.x = right * std::cos(angle) - up * std::sin(angle);
    place.y = up * std::cos(angle) + right * std::sin(angle);
    place.z = back;
  };
  roll_frame(camera.to_world);
  for (Transform& moment : camera.moments) roll_frame(moment);
}

CameraDescription aimed_camera(const Subject& subject, const FittedView& view) {
  CameraDescription camera;
  camera.name = "fitted";
  camera.yfov = view.yfov;
  if (view.orthographic) camera.kind = CameraDescription::Kind::orthographic;
  const float azimuth = view.azimuth.value_or(default_azimuth);
  const float elevation = view.elevation.value_or(default_elevation);
  turn(camera, orbit_direction(azimuth, elevation), orbit_up(azimuth, elevation));
  if (!view.azimuth && !view.elevation && !subject.empty())
    if (const auto normal = subject.flat_normal(camera.to_world.z))
      turn(camera, *normal, std::abs(normal->y) < 0.99f ? Vec3f(0, 1, 0) : Vec3f(0, 0, -normal->y));
  roll(camera, view.roll);
  return camera;
}

CameraDescription fitted_camera(const Subject& subject, float aspect, const FittedView& view) {
  const Bounds seen = subject.bounds_to_see();
  const FarthestPoint farthest = [&](const Vec3f& direction) {
    if (!subject.empty()) return subject.farthest(direction);
    return Vec3f(direction.x > 0 ? seen.upper.x : seen.lower.x, direction.y > 0 ? seen.upper.y : seen.lower.y,
                 direction.z > 0 ? seen.upper.z : seen.lower.z);
  };
  return fit_camera(aimed_camera(subject, view), farthest, aspect, view.margin);
}

CameraDescription fitted_camera(const Scene& scene, float aspect, const FittedView& view) {
  return fitted_camera(Subject(scene.geometry()), aspect, view);
}

}  // namespace vernier
