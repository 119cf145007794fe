#include "scene/lights/triangle_light.h"

#include "core/sampling/warp.h"
#include "scene/emission.h"

namespace vernier {

TriangleLight::TriangleLight(const SceneGeometry& geometry, const Material& material, uint32_t instance,
                             uint32_t primitive)
    : geometry_(&geometry),
      material_(&material),
      instance_(instance),
      primitive_(primitive),
      corners_(geometry.triangle(instance, primitive)),
      area_(length(cross(corners_[1] - corners_[0], corners_[2] - corners_[0])) / 2) {
  const SurfacePoint first = geometry.surface_point(instance, primitive, {0, 0});
  normal_ = first.ng;
  // The bound is linear in the barycentrics, so it is largest at a corner.
  error_ = max(first.error, max(geometry.surface_point(instance, primitive, {1, 0}).error,
                                geometry.surface_point(instance, primitive, {0, 1}).error));
  power_ = mean_power();
}

Rgb TriangleLight::emission(const Vec2f& barycentrics, bool front, const Vec3f& wo) const {
  if (!material_->needs_attributes() && !material_->has_coat()) return material_->emission({}, front, 1);
  const SurfacePoint point = geometry_->surface_point(instance_, primitive_, barycentrics);
  return vernier::emission(*geometry_, *material_, point, front, wo);
}

std::optional<LightSample> TriangleLight::sample(const SurfacePoint& from, const Vec2f& u) const {
  const Vec2f barycentrics = sample_triangle(u);
  const Vec3f on = corners_[0] * (1 - barycentrics.x - barycentrics.y) + corners_[1] * barycentrics.x +
                   corners_[2] * barycentrics.y;
  const Vec3f to_light = on - from.position;
  const float distance2 = length_squared(to_light);
  if (!(distance2 > 0)) return std::nullopt;
  const Vec3f wi = to_light * (1 / std::sqrt(distance2));
  const float cosine = -dot(wi, normal_);
  const Rgb radiance = emission(barycentrics, cosine > 0, -wi);
  if (cosine == 0 || is_black(radiance)) return std::nullopt;
  const float pdf = distance2 / (std::abs(cosine) * area_);
  return LightSample{wi, radiance, pdf, false, from.spawn_to(on, error_, normal_, {instance_, primitive_})};
}

LightEval TriangleLight::eval(const SurfacePoint& from, const Vec3f& wi, const SurfacePoint* on) const {
  const float distance2 = length_squared(on->position - from.position);
  const float cosine = std::abs(dot(wi, on->ng));
  const Rgb radiance = emission({on->u, on->v}, on->front, -wi);
  if (cosine == 0 || is_black(radiance)) return {radiance, 0};
  return {radiance, distance2 / (cosine * area_)};
}

std::optional<LightBounds> TriangleLight::bounds() const {
  LightBounds bounds;
  for (const Vec3f& corner : corners_) bounds.box.add(corner);
  bounds.axis = normal_;
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
      for (const bool front : {true, false}) sum += emission(barycentrics, front, normal_);
      if (!material_->needs_attributes()) return pi * area_ * luminance(sum);
    }
  return pi * area_ * luminance(sum) / float(count);
}

}  // namespace vernier
