// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scene/lights/light_bounds.h"
#include "scene/surface_point.h"

namespace vernier {

class Light;

/// What a light is part of.
struct LightSource {
  enum class Kind : uint8_t { instance, lamp, environment };
  Kind kind = Kind::environment;
  uint32_t index = 0;  ///< of the instance, or of the punctual light of the description
};

/// Light that may reach a point from one direction, before what lies between.
struct LightSample {
  Vec3f wi;  ///< unit, from the point toward the light
  /// Radiance, of a light that is covered in part its mean; for a delta light the irradiance on a surface
  /// facing it.
  Rgb radiance{0, 0, 0};
  float pdf = 0;          ///< per solid angle; 1 for a delta light
  bool is_delta = false;  ///< cannot be met by a ray
  Ray shadow;             ///< from the point to the light: what lies on it takes its part
  LightSource source;     ///< this and what follows are set by Scene::sample_light
  const Light* light = nullptr;
  float choice_prob = 1;  ///< of having chosen the light among all, in `pdf` or `radiance` already
};

/// Light met along a direction, and how sample() would have produced it.
struct LightEval {
  Rgb radiance{0, 0, 0};
  float pdf = 0;  ///< per solid angle; 0: sample() never does
};

/// Light on its way from a light into the scene.
struct LightRay {
  Ray ray;            ///< unit direction, free of self-intersection
  Rgb flux{0, 0, 0};  ///< in watts: over the density of the ray, so that its mean is the light's power
  /// Metres after which nothing of it arrives, and before which it fades (range_window); of lamps only.
  float range = std::numeric_limits<float>::infinity();
};

/// The window by which a lamp's light ends smoothly at its range (KHR_lights_punctual, "Range Property").
inline float range_window(float range, float distance2) {
  return std::isfinite(range) ? std::clamp(1 - square(distance2 / square(range)), 0.f, 1.f) : 1;
}

/// A source of light. Immutable; called from many threads.
class Light {
 public:
  virtual ~Light() = default;

  /// A direction from `from` toward the light; empty where it contributes nothing.
  virtual std::optional<LightSample> sample(const SurfacePoint& from, const Vec2d& u) const = 0;

  /// What arrives at `from` along the unit direction -wi from the point `on` of this light (null: from
  /// infinity), which a ray has met and which therefore is there.
  virtual LightEval eval(const SurfacePoint& from, const Vec3f& wi, const SurfacePoint* on) const = 0;

  /// A ray of its light: `place` chooses where it begins, of a lamp with a place where it goes, `direction`
  /// the rest, `time` of the shutter when. Lights at infinity shine through a disk about `scene`, the bounds
  /// of all that they may meet.
  virtual std::optional<LightRay> emit(const Bounds& scene, const Vec2d& place, const Vec2f& direction,
                                       float time) const = 0;

  /// Emitted power in watts, as far as needed to choose between lights; positive if the light contributes
  /// anywhere. `scene`: bounds that lights at infinity shine on.
  virtual float power(const Bounds& scene) const = 0;

  /// Where it is and what it shines on; empty for a light at infinity.
  virtual std::optional<LightBounds> bounds() const { return std::nullopt; }

  /// Whether its samples are delta ones, always.
  virtual bool is_delta() const { return false; }

  /// What it is part of.
  virtual LightSource source() const = 0;
};

}  // namespace vernier
