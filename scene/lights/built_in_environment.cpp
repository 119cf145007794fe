// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/built_in_environment.h"

#include <array>

#include "core/base/names.h"
#include "core/base/parallel.h"
#include "core/image/image_io.h"

namespace vernier {
namespace {

constexpr float degree = pi / 180;

/// A rectangle of light at infinity. Angles in degrees as a camera sees them that looks along -z: azimuth 0
/// ahead, positive to the right; elevation above the horizon.
struct Softbox {
  float azimuth, elevation;
  float half_width, half_height;
  float radiance;
  float softness;  ///< degrees over which its edge fades
};

constexpr std::array<Softbox, 5> softboxes{{
    {-128, 40, 24, 19, 5.4f, 3},  // key
    {125, 20, 34, 28, 0.6f, 14},  // fill
    {0, 86, 30, 30, 0.5f, 12},    // overhead
    {-72, 24, 7, 30, 3.0f, 3},    // rim, left
    {66, 30, 8, 32, 3.4f, 3},     // rim, right
}};

float smooth_step(float lower, float upper, float x) {
  const float t = std::clamp((x - lower) / (upper - lower), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

Vec3f direction(float azimuth, float elevation) {
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          -std::cos(azimuth) * std::cos(elevation)};
}

/// How much of a softbox lies in the direction w, from 0 to 1.
float covers(const Softbox& box, const Vec3f& w) {
  const Vec3f axis = direction(box.azimuth * degree, box.elevation * degree);
  const Vec3f right = direction((box.azimuth + 90) * degree, 0);
  const float depth = dot(w, axis);
  if (depth <= 0) return 0;
  const float x = std::atan2(std::abs(dot(w, right)), depth) / degree;
  const float y = std::atan2(std::abs(dot(w, cross(right, axis))), depth) / degree;
  return (1 - smooth_step(box.half_width - box.softness, box.half_width, x)) *
         (1 - smooth_step(box.half_height - box.softness, box.half_height, y));
}

/// Floor and backdrop are one hollow, bright below and dark above, with no horizon between them.
float room(const Vec3f& w) { return lerp(smooth_step(-0.75f, 0.5f, w.y), 0.34f, 0.08f); }

float studio_radiance(const Vec3f& w) {
  float radiance = room(w);
  for (const Softbox& box : softboxes) radiance += box.radiance * covers(box, w);
  return radiance;
}

float sky_radiance(const Vec3f& w) { return w.y > 0 ? 0.6f + 0.4f * w.y : 0.3f; }

/// Grey latitude-longitude picture of a radiance.
std::shared_ptr<const Image> paint(int width, int height, float (*radiance)(const Vec3f&)) {
  auto picture = std::make_shared<Image>(width, height, 3);
  parallel_for(size_t(height), [&](size_t y) {
    const float theta = pi * (float(y) + 0.5f) / float(height);
    for (int x = 0; x < width; ++x) {
      const float phi = 2 * pi * ((float(x) + 0.5f) / float(width) - 0.5f);
      const float value =
          radiance({std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)});
      std::fill_n(picture->pixel(x, int(y)), 3, value);
    }
  });
  return picture;
}

}  // namespace

const std::vector<BuiltInEnvironment>& built_in_environments() {
  static const std::vector<BuiltInEnvironment> table{
      {"studio", "softboxes over a neutral ground, turned with the camera", true,
       [] {
         // Every picture of a turntable asks for it again.
         static const std::shared_ptr<const Image> picture = paint(1024, 512, studio_radiance);
         return picture;
       }},
      {"sky", "a soft sky, bright overhead", false, [] { return paint(2, 64, sky_radiance); }}};
  return table;
}

float heading(const CameraDescription& camera) {
  const Vec3f ahead = -normalize(camera.to_world.z);
  const float across = std::hypot(ahead.x, ahead.z);
  const Vec3f to = across > 0.02f ? ahead : (ahead.y < 0 ? camera.to_world.y : -camera.to_world.y);
  return std::atan2(-to.x, -to.z);
}

std::shared_ptr<const EnvironmentDescription> built_in_environment(const std::string& name,
                                                                   const CameraDescription& camera) {
  const auto& entry = find_by_name(built_in_environments(), "environment", name);
  auto environment = std::make_shared<EnvironmentDescription>();
  environment->picture = entry.picture();
  if (entry.turns_with_camera) environment->rotation = heading(camera);
  return environment;
}

std::shared_ptr<const EnvironmentDescription> read_environment(const std::string& path) {
  auto environment = std::make_shared<EnvironmentDescription>();
  environment->picture = std::make_shared<const Image>(read_image(path));
  return environment;
}

}  // namespace vernier
