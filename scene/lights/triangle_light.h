#pragma once

#include "scene/geometry.h"
#include "scene/lights/light.h"

namespace vernier {

/// One emissive triangle, sampled by area. The emission may vary over it by texture.
class TriangleLight : public Light {
 public:
  TriangleLight(const SceneGeometry& geometry, const Material& material, uint32_t instance,
                uint32_t primitive);

  std::optional<LightSample> sample(const SurfacePoint& from, const Vec2f& u) const override;
  LightEval eval(const SurfacePoint& from, const Vec3f& wi, const SurfacePoint* on) const override;
  float power(const Bounds& /*scene*/) const override { return power_; }
  std::optional<LightBounds> bounds() const override;

 private:
  Rgb emission(const Vec2f& barycentrics, bool front, const Vec3f& wo) const;
  float mean_power() const;

  const SceneGeometry* geometry_;
  const Material* material_;
  uint32_t instance_, primitive_;
  std::array<Vec3f, 3> corners_;  ///< world
  Vec3f normal_;                  ///< of the front
  Vec3f error_;                   ///< bound on the rounding of any point between the corners
  float area_, power_;
};

}  // namespace vernier
