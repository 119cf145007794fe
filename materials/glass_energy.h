#pragma once

#include <array>
#include <mutex>

#include "core/math/vec.h"

namespace vernier {

/// How much of the light a rough clear boundary reflects and transmits after one bounce on its facets; the
/// rest is blocked by other facets or leaves a facet toward the wrong side of the surface. One table for each
/// relative index.
class GlassEnergy {
 public:
  /// The table of relative index eta (far side over near side), kept for good. May be called from any thread.
  static const GlassEnergy& of(float eta);

  /// Directional albedo at cos_theta in [0,1] for width alpha in [0,1] when the Fresnel reflectance, but for
  /// total internal reflection, is multiplied by reflect_scale and what is not reflected is transmitted:
  /// within 1e-3 for scales up to 1, 3e-3 where the indices differ by a percent; above 1 an upper bound,
  /// because reflectance is clipped. A width seen for the first time costs some 10 ms of integration.
  Rgb albedo(float cos_theta, float alpha, const Rgb& reflect_scale) const;

  explicit GlassEnergy(float eta) : eta_(eta) {}

 private:
  struct Node {
    float missing = 0;  ///< 1 - albedo with unscaled reflectance
    float exchange =
        0;  ///< what the albedo loses when light that is not totally reflected is transmitted instead
  };
  struct Row {
    static constexpr int cosines = 64;
    std::once_flag once;
    std::array<Node, cosines> nodes;

    Node at(float coordinate) const;
  };

  const Row& row(int index) const;
  Node integrate(float cos_theta, float alpha) const;

  static constexpr int widths = 32;
  float eta_;
  mutable std::array<Row, widths> rows_;
};

}  // namespace vernier
