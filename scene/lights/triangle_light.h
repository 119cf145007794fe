// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/sampling/distribution.h"
#include "scene/geometry.h"
#include "scene/lights/light.h"

namespace vernier {

class TriangleLight;

/// Where a triangle light is at one time.
struct LightShape {
  std::array<Vec3f, 3> corners;   ///< world, in the order of barycentrics
  std::optional<Vec3f> opposite;  ///< of a parallelogram: the corner that lies across from the first
  Vec3f normal;                   ///< unit, of the front
  Vec3f error;                    ///< bound on the rounding of any point between the corners
  float area;

  Vec3f at(const Vec2f& place) const;
};

/// What the triangle lights of one instance have in common.
class EmissiveMesh {
 public:
  /// These must live as long.
  EmissiveMesh(const SceneGeometry& geometry, const Material& material, uint32_t instance);

  /// Once all its lights are made, which follow each other from here on: where none needs a table, there are
  /// none, and if `ready` the shapes of lights that stand still are kept.
  void settle(std::span<const TriangleLight> lights, bool ready);

 private:
  friend class TriangleLight;

  /// Of a material that emits the same at every point.
  struct EvenEmission {
    std::array<Rgb, 2> emission;  ///< of the back and of the front
    float coverage = 1;
  };

  const SceneGeometry* geometry_;
  const Material* material_;
  uint32_t instance_;
  size_t moments_;  ///< at so many it is known where the triangles are; 0: they stand still
  std::optional<EvenEmission> even_;
  /// By triangle, of emission over the square that sample_triangle() maps; null: even. Empty where the
  /// material emits evenly.
  std::vector<std::unique_ptr<const Distribution2D>> textures_;
  const TriangleLight* first_ = nullptr;
  std::vector<LightShape> shapes_;  ///< in the order of the lights; empty: read from the mesh each time
};

/// An emissive triangle, or two that make up a parallelogram and emit the same everywhere. Sampled by solid
/// angle from nearby and else by area; a triangle that its texture lights unevenly, in proportion to that.
/// Where it is, is kept ready only where there are few: millions would fill the memory.
class TriangleLight : public Light {
 public:
  /// Of no power.
  TriangleLight() = default;
  /// The mesh must live as long.
  TriangleLight(EmissiveMesh& mesh, uint32_t primitive);

  /// How another triangle makes up a parallelogram with this one.
  struct Joint {
    uint8_t first = 0;   ///< corner of this triangle that lies across from the edge that both have
    uint8_t across = 0;  ///< of the other
  };
  /// Empty if it does not. Of the same mesh, neither joined to another yet.
  std::optional<Joint> joint(const TriangleLight& other) const;
  /// Takes in another triangle: one light, sampled as one, has less noise than two.
  void take_in(const TriangleLight& other, Joint joint);

  std::optional<LightSample> sample(const SurfacePoint& from, const Vec2d& u) const override;
  LightEval eval(const SurfacePoint& from, const Vec3f& wi, const SurfacePoint* on) const override;
  std::optional<LightRay> emit(const Bounds& scene, const Vec2d& place, const Vec2f& direction,
                               float time) const override;
  float power(const Bounds& /*scene*/) const override { return power_; }
  std::optional<LightBounds> bounds() const override;
  LightSource source() const override { return {LightSource::Kind::instance, mesh_->instance_}; }

 private:
  friend class EmissiveMesh;
  class View;

  /// Null: it has to be found.
  const LightShape* ready_shape() const {
    return mesh_->shapes_.empty() ? nullptr : &mesh_->shapes_[size_t(this - mesh_->first_)];
  }
  LightShape shape_at(float time) const;
  LightShape moment(size_t i) const;
  LightBounds bounds_at(const LightShape& shape) const;
  bool is_joined() const { return opposite_ != primitive_; }
  /// Null: it emits evenly.
  const Distribution2D* texture() const {
    return mesh_->textures_.empty() ? nullptr : mesh_->textures_[primitive_].get();
  }
  /// A place by its part of the area, or of the texture's light, with the density per square metre.
  Vec2f place_by_area(const LightShape& shape, const Vec2f& u, float& pdf) const;
  TriangleId triangle_at(const Vec2f& place) const;
  Rgb emission(const Vec2f& barycentrics, float time, bool front, const Vec3f& wo) const;
  float coverage(const Vec2f& barycentrics) const;
  void measure_emission(EmissiveMesh& mesh);

  const EmissiveMesh* mesh_ = nullptr;
  uint32_t primitive_ = 0, opposite_ = 0;  ///< the same: a triangle alone
  float power_ = 0;
  Joint joint_;
};

}  // namespace vernier
