// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/math/ray.h"
#include "scene/lights/punctual.h"

// Where a medium scatters the light of lamps that are points: near them by the inverse square of the
// distance, without bound, which no other choice of a place to scatter makes up for.

namespace vernier {

/// The lamps of a scene that have a place: point lamps and spots.
class Lamps {
 public:
  /// The light of that index in the LightSet, which must live as long, at a place.
  void add(const PunctualLight& lamp, uint32_t light) { lamps_.push_back({&lamp, lamp.power({}), light}); }

  bool empty() const { return lamps_.empty(); }

 private:
  friend class LampsAlongRay;

  struct Lamp {
    const PunctualLight* lamp;
    float power;
    uint32_t light;
  };
  std::vector<Lamp> lamps_;
};

/// Chooses a lamp, and a point on a part of a ray by how much of its light arrives there: evenly in the angle
/// under which the lamp sees the ray (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path
/// Tracing in Participating Media", section 3), where its cone and range reach it.
class LampsAlongRay {
 public:
  /// The direction of `ray` is a unit vector; `end` may be infinite. `lamps` must live as long.
  LampsAlongRay(const Lamps& lamps, const Ray& ray, float begin, float end);

  struct Sample {
    uint32_t light;  ///< index in the LightSet
    float t;         ///< parameter of the ray
    float pdf;       ///< of the lamp and of t, per metre
  };
  /// u picks the lamp, v the point; empty when no lamp shines on the ray.
  std::optional<Sample> sample(float u, float v) const;
  /// Of sample() choosing that light at t; 0 where it is none of the lamps.
  float pdf(const Light* light, float t) const;

 private:
  /// More lamps than these are picked alike, without being looked at one by one.
  static constexpr size_t most_weighed = 32;

  /// How a lamp sees the part of the ray that it lights.
  struct View {
    double nearest = 0, distance = 0;  ///< parameter of the point nearest to it, and how far that is
    double first = 0, last = 0;        ///< angles from there to the ends, radians
    double extent() const { return last - first; }
  };
  View view(const Lamps::Lamp& lamp) const;
  float prob(size_t lamp) const;
  static double density(const View& view, double t);

  const std::vector<Lamps::Lamp>& lamps_;
  Vec3d origin_, direction_;
  double begin_, end_;
  float time_;
  std::array<View, most_weighed> views_;
  std::array<float, most_weighed> weights_;
  float all_weights_ = 0;
};

}  // namespace vernier
