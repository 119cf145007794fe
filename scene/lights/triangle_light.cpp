#include "scene/lights/triangle_light.h"

#include "core/sampling/warp.h"

namespace vernier {

TriangleLight::TriangleLight(const SceneGeometry& geometry, const Material& material, uint32_t instance,
                             uint32_t primitive)
    : geometry_(&geometry), material_(&material), instance_(instance), primitive_(primitive) {
  const auto [a, b, c] = geometry.triangle(instance, primitive);
  area_ = length(cross(b - a, c - a)) / 2;
  power_ = mean_power();
}

Rgb TriangleLight::emission(const SurfacePoint& point, bool front) const {
  return material_->emission(
      material_->needs_attributes() ? geometry_->attributes(point) : SurfaceAttributes{}, front);
}

std::optional<LightSample> TriangleLight::sample(const SurfacePoint& from, const Vec2f& u) const {
  const SurfacePoint on = geometry_->surface_point(instance_, primitive_, sample_triangle(u));
  const Vec3f to_light = on.position - from.position;
  const float distance2 = length_squared(to_light);
  if (!(distance2 > 0)) return std::nullopt;
  const Vec3f wi = to_light * (1 / std::sqrt(distance2));
  const float cosine = -dot(wi, on.ng);
  const Rgb radiance = emission(on, cosine > 0);
  if (cosine == 0 || is_black(radiance)) return std::nullopt;
  const float pdf = distance2 / (std::abs(cosine) * area_);
  return LightSample{wi, radiance, pdf, false, from.spawn_to(on.position, on.error, on.ng)};
}

LightEval TriangleLight::eval(const SurfacePoint& from, const Vec3f& wi, const SurfacePoint* on) const {
  const float distance2 = length_squared(on->position - from.position);
  const float cosine = std::abs(dot(wi, on->ng));
  const Rgb radiance = emission(*on, on->front);
  if (cosine == 0 || is_black(radiance)) return {radiance, 0};
  return {radiance, distance2 / (cosine * area_)};
}

std::optional<LightBounds> TriangleLight::bounds() const {
  LightBounds bounds;
  for (const Vec3f& corner : geometry_->triangle(instance_, primitive_)) bounds.box.add(corner);
  bounds.axis = geometry_->surface_point(instance_, primitive_, {0, 0}).ng;
  bounds.power = power_;
  bounds.two_sided = material_->double_sided();
  return bounds;
}

float TriangleLight::mean_power() const {
  // Mean emission over a fixed lattice: fine enough to find a lit patch of a few percent of the triangle; one
  // that it misses is no light, and BSDF sampling alone finds it.
  constexpr int steps = 12;
  Rgb sum(0, 0, 0);
  int count = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps - i; ++j, ++count) {
      const Vec2f barycentrics((float(i) + 1 / 3.f) / steps, (float(j) + 1 / 3.f) / steps);
      const SurfacePoint point = geometry_->surface_point(instance_, primitive_, barycentrics);
      sum += emission(point, true) + emission(point, false);
      if (!material_->needs_attributes()) return pi * area_ * luminance(sum);
    }
  return pi * area_ * luminance(sum) / float(count);
}

}  // namespace vernier
