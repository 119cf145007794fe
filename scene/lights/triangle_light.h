// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/sampling/distribution.h"
#include "scene/geometry.h"
#include "scene/lights/light.h"

namespace vernier {

/// An emissive triangle, or two that make up a parallelogram and emit the same everywhere. Sampled by solid
/// angle from nearby and else by area; a triangle that its texture lights unevenly, in proportion to that.
class TriangleLight : public Light {
 public:
  TriangleLight(const SceneGeometry& geometry, const Material& material, uint32_t instance,
                uint32_t primitive);

  /// Takes in another triangle of the same instance if both make up such a parallelogram: one light, sampled
  /// as one, has less noise than two. False: nothing has changed.
  bool try_merge_quad(const TriangleLight& other);

  std::optional<LightSample> sample(const SurfacePoint& from, const Vec2d& u) const override;
  LightEval eval(const SurfacePoint& from, const Vec3f& wi, const SurfacePoint* on) const override;
  std::optional<LightRay> emit(const Bounds& scene, const Vec2d& place, const Vec2f& direction,
                               float time) const override;
  float power(const Bounds& /*scene*/) const override { return power_; }
  std::optional<LightBounds> bounds() const override;

 private:
  class View;

  /// Where it is at one time.
  struct Shape {
    std::array<Vec3f, 3> corners;   ///< world, counter-clockwise seen from the front
    std::optional<Vec3f> opposite;  ///< of a parallelogram: the corner that lies across from the first
    Vec3f normal;                   ///< unit, of the front
    Vec3f error;                    ///< bound on the rounding of any point between the corners
    float area;
    float near2;  ///< squared distance of the center within which it is sampled by solid angle

    Vec3f at(const Vec2f& place) const;
  };
  Shape shape_at(float time) const;
  Shape moment(size_t i) const;
  LightBounds bounds_at(const Shape& shape) const;
  /// A place by its part of the area, or of the texture's light, with the density per square metre.
  Vec2f place_by_area(const Shape& shape, const Vec2f& u, float& pdf) const;
  TriangleId triangle_at(const Vec2f& place) const;
  Rgb emission(const Vec2f& barycentrics, float time, bool front, const Vec3f& wo) const;
  float coverage(const Vec2f& barycentrics) const;
  void measure_emission();

  /// Of a material that emits the same at every point.
  struct EvenEmission {
    std::array<Rgb, 2> emission;  ///< of the back and of the front
    float coverage = 1;
  };

  const SceneGeometry* geometry_;
  const Material* material_;
  uint32_t instance_, primitive_;
  std::optional<EvenEmission> even_;
  /// Of emission over the square that sample_triangle() maps; null: even.
  std::unique_ptr<const Distribution2D> texture_;
  Shape shape_;         ///< in the middle of the shutter
  size_t moments_ = 0;  ///< at so many it is known where the triangle is; 0: it stands still
  uint32_t opposite_primitive_ = 0;
  float power_ = 0;
};

}  // namespace vernier
