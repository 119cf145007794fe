// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/punctual.h"

#include <fmt/format.h>

#include "core/math/frame.h"
#include "core/math/moments.h"
#include "core/sampling/warp.h"
#include "scene/lights/infinite_disk.h"
#include "scene/moving_mesh.h"

namespace vernier {

using Kind = PunctualLightDescription::Kind;

PunctualLight::PunctualLight(const PunctualLightDescription& d, uint32_t number)
    : kind_(d.kind),
      number_(number),
      place_{d.to_world.origin, normalize(-d.to_world.z)},
      intensity_(d.color * d.intensity),
      range_(d.range),
      cos_inner_(std::cos(d.inner_cone)),
      cos_outer_(std::cos(d.outer_cone)) {
  check_moment_count(d.moments.size(), fmt::format("the light '{}'", d.name));
  for (const Transform& m : d.moments) moments_.push_back({m.origin, normalize(-m.z)});
}

PunctualLight::Place PunctualLight::place_at(float time) const {
  if (moments_.empty()) return place_;
  const auto [first, part] = moments_around(time, moments_.size());
  const Place &from = moments_[first], &to = moments_[first + 1];
  return {between(from.position, to.position, part),
          unit_or(between(from.direction, to.direction, part), from.direction)};
}

std::optional<LightSample> PunctualLight::sample(const SurfacePoint& from, const Vec2d& /*u*/) const {
  const auto [position, direction] = place_at(from.time);
  LightSample sample;
  sample.pdf = 1;
  sample.is_delta = true;
  if (kind_ == Kind::directional) {
    sample.wi = -direction;
    sample.radiance = intensity_;
    sample.shadow = from.spawn(sample.wi);
    return sample;
  }
  const Vec3f to_light = position - from.position;
  const float distance2 = length_squared(to_light);
  if (!(distance2 > 0)) return std::nullopt;
  sample.wi = to_light * (1 / std::sqrt(distance2));
  float attenuation = 1 / distance2 * range_window(range_, distance2);
  if (kind_ == Kind::spot) attenuation *= spot_window(-dot(sample.wi, direction));
  if (!(attenuation > 0)) return std::nullopt;
  sample.radiance = intensity_ * attenuation;
  sample.shadow = from.spawn_to(position, {0, 0, 0}, {0, 0, 1});
  return sample;
}

/// KHR_lights_punctual, "Inner and Outer Cone Angles", without its sample code's lower limit of the width,
/// which would dim narrow cones and blur sharp edges.
float PunctualLight::spot_window(float cosine) const {
  const float inside = cosine - cos_outer_, width = cos_inner_ - cos_outer_;
  if (inside < 0) return 0;
  return inside < width ? square(inside / width) : 1;
}

std::optional<LightRay> PunctualLight::emit(const Bounds& scene, const Vec2d& place,
                                            const Vec2f& /*direction*/, float time) const {
  const auto [position, axis] = place_at(time);
  const Vec2f u = to_float(place);
  if (kind_ == Kind::directional) return emit_from_infinity(scene, axis, intensity_, u, time);
  LightRay light{{position, 0, sample_sphere(u)}, intensity_ / sphere_pdf(), range_};
  light.ray.time = time;
  if (kind_ == Kind::spot) {
    // Uniform over the cap of directions of the cone, by Archimedes' hat-box theorem.
    const float cosine = 1 - u.x * (1 - cos_outer_), sine = safe_sqrt(1 - square(cosine));
    const float phi = 2 * pi * u.y;
    light.ray.direction =
        Frame::from_normal(axis).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
    light.flux = intensity_ * (2 * pi * (1 - cos_outer_) * spot_window(cosine));
  }
  if (is_black(light.flux)) return std::nullopt;
  return light;
}

LightEval PunctualLight::eval(const SurfacePoint& /*from*/, const Vec3f& /*wi*/,
                              const SurfacePoint* /*on*/) const {
  return {};
}

float PunctualLight::power(const Bounds& scene) const {
  const float intensity = luminance(intensity_);
  switch (kind_) {
    case Kind::point:
      return 4 * pi * intensity;
    case Kind::spot:
      return 2 * pi * intensity * ((1 - cos_inner_) + (cos_inner_ - cos_outer_) / 3);
    case Kind::directional:
      return pi * square(scene.radius()) * intensity;
  }
  return 0;
}

std::optional<LightBounds> PunctualLight::bounds() const {
  if (kind_ == Kind::directional) return std::nullopt;
  if (moments_.empty()) return bounds_at(place_);
  LightBounds all;
  for (const Place& moment : moments_) all = merge(all, bounds_at(moment));
  all.power = power({});
  return all;
}

LightBounds PunctualLight::bounds_at(const Place& place) const {
  LightBounds bounds;
  bounds.box.add(place.position);
  bounds.axis = place.direction;
  bounds.power = power({});
  if (kind_ == Kind::spot) {
    bounds.cos_emission = cos_outer_;
  } else {
    bounds.cos_spread = -1;
  }
  return bounds;
}

}  // namespace vernier
