// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "integrators/integrator.h"
#include "scene/scene.h"
#include "tests/support/statistics.h"

// Scenes built in code, and measurements of the light that arrives along a ray.

namespace vernier::test {

/// Diffuse reflectance and nothing else: no specular layer.
MaterialDescription diffuse(float reflectance);
/// Black, emitting this radiance from its front.
MaterialDescription emitter(float radiance);
/// White metal.
MaterialDescription metal(float roughness);
/// White body under a dielectric surface.
MaterialDescription plastic(float roughness);
/// Clear boundary of a volume of index 1.5.
MaterialDescription glass(float roughness);

/// A lamp that shines evenly all around, and one at infinity that shines along `shines`.
PunctualLightDescription point_lamp(const Vec3f& at, float intensity);
PunctualLightDescription sun(const Vec3f& shines, float irradiance);

/// Parallelogram with the front toward cross(a, b); texture coordinates go from 0 to 1 along a and b.
MeshDescription parallelogram(const Vec3f& corner, const Vec3f& a, const Vec3f& b);
/// Closed box, fronts outward or inward.
MeshDescription box(const Vec3f& lower, const Vec3f& upper, bool inward = false);
/// Sphere of rings * segments * 2 triangles, vertices on it, flat shading, fronts outward.
MeshDescription sphere(const Vec3f& center, float radius, int rings, int segments);
/// The same with the normals of a true sphere.
MeshDescription smooth_sphere(const Vec3f& center, float radius, int rings, int segments);
/// Regular polygon of n corners on a circle at height y, front downward.
MeshDescription disk_facing_down(float y, float radius, int n);

class SceneBuilder {
 public:
  SceneBuilder& add(MeshDescription mesh, const MaterialDescription& material,
                    const Transform& to_world = {});
  SceneBuilder& add(const PunctualLightDescription& light);
  /// A texture of grey texels that does not interpolate; materials name them in the order added.
  SceneBuilder& texture(int width, int height, const std::vector<uint8_t>& texels);
  /// The same of white texels with this alpha.
  SceneBuilder& alpha_texture(int width, int height, const std::vector<uint8_t>& alphas);
  /// Radiance as a function of the direction it comes from, on a picture of 2 height x height texels.
  SceneBuilder& environment(const std::function<float(const Vec3f&)>& radiance, int height = 64);
  Scene build(const std::string& accelerator = {});
  const SceneDescription& description() const { return description_; }

 private:
  SceneDescription description_;
};

/// Flames on cards, the first texture of the scene: what it leaves open neither glows nor hides.
void add_flame_cards(SceneBuilder& builder, AlphaMode mode);

/// The path integrator.
std::unique_ptr<Integrator> path(const IntegratorOptions& options);

/// Means of independent sets of `samples` stratified samples each of the radiance along `ray`, first channel.
/// Values within a set are not independent; their means are. `spread`: see SampleContext.
Samples measure(const Scene& scene, const Integrator& integrator, const Ray& ray, int samples, int sets = 16,
                uint64_t seed = 1, float spread = 0);

/// Ray from `from` through `to`, unit direction.
Ray ray_through(const Vec3f& from, const Vec3f& to);

/// Whether the radiance along `ray` is `expected` within `resolution` times it. Samples are doubled until a
/// bias of that size would be found nine times in ten; it is a failure when 2^18 a set do not suffice.
/// A sanitized build resolves less (tests/support/effort.h).
::testing::AssertionResult sees(const Scene& scene, const Integrator& integrator, const Ray& ray,
                                double expected, double resolution);

}  // namespace vernier::test
