// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/sampling/distribution.h"
#include "scene/scene.h"
#include "vernier/settings.h"

namespace vernier {

/// Draws light of a scene at its sources: of all lights by their power, or of lamps and rather what they send
/// to surfaces that mirror or bend it sharply.
class LightEmission {
 public:
  struct Ray : LightRay {
    LightSource source;
  };

  /// Of all lights.
  static LightEmission of_all(const Scene& scene);
  /// Of lamps, aimed; the scene must live as long.
  static LightEmission of_lamps(const Scene& scene);

  /// u chooses the light, the others are as of Light::emit. Empty: a light path that brings nothing.
  std::optional<Ray> sample(double u, const Vec2d& place, const Vec2f& direction, float time) const;

  /// The light that sample() chooses by u, as its number among those it was made of; there must be some.
  struct Choice {
    size_t light;
    float prob;
  };
  Choice choose(double u) const;
  /// Nothing is ever sampled.
  bool empty() const { return by_power_.empty(); }
  /// A ray of that light, its flux over the density of the place.
  std::optional<LightRay> shine(size_t light, const Vec2d& place, const Vec2f& direction, float time) const;

 private:
  explicit LightEmission(const Scene& scene) : bounds_(scene.lit_bounds()) {}

  Bounds bounds_;
  std::vector<const Light*> lights_;
  AliasTable by_power_;
  std::vector<Distribution2D> aims_;  ///< by light, over the places that it takes; empty: evenly
};

/// Whether lamps of the scene shine on surfaces that mirror or bend their light sharply, enough to be worth
/// light paths. By a few thousand rays of fixed numbers.
bool casts_caustics(const Scene& scene);
/// Whether a picture gets light paths for what that casts.
bool follows_caustics(const IntegratorOptions& options, const Scene& scene);

}  // namespace vernier
