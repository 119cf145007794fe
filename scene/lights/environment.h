// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/sampling/distribution.h"
#include "scene/lights/light.h"
#include "vernier/scene.h"

namespace vernier {

/// Radiance from infinity out of a latitude-longitude picture, interpolated bilinearly, sampled in proportion
/// to luminance and solid angle.
class EnvironmentLight : public Light {
 public:
  explicit EnvironmentLight(std::shared_ptr<const EnvironmentDescription> description);

  const EnvironmentDescription& description() const { return *description_; }

  std::optional<LightSample> sample(const SurfacePoint& from, const Vec2d& u) const override;
  LightEval eval(const SurfacePoint& from, const Vec3f& wi, const SurfacePoint* on) const override;
  std::optional<LightRay> emit(const Bounds& scene, const Vec2d& place, const Vec2f& direction,
                               float time) const override;
  float power(const Bounds& scene) const override;
  LightSource source() const override { return {}; }

  /// Radiance arriving from the unit direction w.
  Rgb radiance(const Vec3f& w) const;
  /// Unit direction of a place in the picture, both coordinates in [0, 1].
  Vec3f direction(const Vec2f& uv) const;
  /// Texels that were not finite or negative and count as black.
  size_t bad_texels() const { return bad_texels_; }

 private:
  Rgb texel(int x, int y) const;
  Rgb lookup(const Vec2f& uv) const;
  Vec2f to_uv(const Vec3f& w) const;

  std::shared_ptr<const EnvironmentDescription> description_;
  float cos_rotation_, sin_rotation_;
  Distribution2D distribution_;
  size_t bad_texels_ = 0;
};

}  // namespace vernier
