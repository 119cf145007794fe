// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/lights/light.h"
#include "vernier/scene.h"

namespace vernier {

/// Point, spot or directional light of KHR_lights_punctual: a delta light, which no ray meets.
class PunctualLight : public Light {
 public:
  /// The description is that of this number among those of the scene.
  explicit PunctualLight(const PunctualLightDescription& description, uint32_t number = 0);

  std::optional<LightSample> sample(const SurfacePoint& from, const Vec2d& u) const override;
  LightEval eval(const SurfacePoint& from, const Vec3f& wi, const SurfacePoint* on) const override;
  std::optional<LightRay> emit(const Bounds& scene, const Vec2d& place, const Vec2f& direction,
                               float time) const override;
  float power(const Bounds& scene) const override;
  std::optional<LightBounds> bounds() const override;
  bool is_delta() const override { return true; }
  LightSource source() const override { return {LightSource::Kind::lamp, number_}; }

  /// Where it is, and where spot and directional lights shine to.
  struct Place {
    Vec3f position, direction;
  };
  /// At a time of the shutter.
  Place place_at(float time) const;
  /// A directional one.
  bool is_at_infinity() const { return kind_ == PunctualLightDescription::Kind::directional; }
  float range() const { return range_; }
  /// Of the half angle that it shines into; -1: to all sides.
  float cos_outer() const { return kind_ == PunctualLightDescription::Kind::spot ? cos_outer_ : -1; }

 private:
  LightBounds bounds_at(const Place& place) const;
  /// Angular attenuation of a spot; cosine: of the angle between its axis and where it shines to.
  float spot_window(float cosine) const;

  PunctualLightDescription::Kind kind_;
  uint32_t number_;
  Place place_;                 ///< in the middle of the shutter
  std::vector<Place> moments_;  ///< empty: it stands still
  Rgb intensity_;
  float range_, cos_inner_, cos_outer_;
};

}  // namespace vernier
