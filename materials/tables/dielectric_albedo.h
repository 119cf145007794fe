// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <mutex>

#include "materials/fresnel.h"

namespace vernier {

/// How much of the light a rough clear boundary reflects and transmits after one bounce on its facets; the
/// rest is blocked by other facets or leaves a facet toward the wrong side of the surface. One table for each
/// relative index.
class DielectricAlbedo {
 public:
  /// The table of relative index eta (far side over near side), kept for good. May be called from any thread.
  static const DielectricAlbedo& of(float eta);

  /// Directional albedo at cos_theta in [0,1] for width alpha in [0,1] when reflectance follows Fresnel's
  /// curve between those of `ends` (total internal reflection stays total) and what is not reflected is
  /// transmitted: within 1e-3, 3e-3 where the indices differ by a percent. A width seen for the first time
  /// costs some 10 ms of integration.
  float albedo(float cos_theta, float alpha, const SchlickCurve& ends) const;

  explicit DielectricAlbedo(float eta) : eta_(eta) {}

 private:
  struct Node {
    float missing = 0;  ///< 1 - albedo with Fresnel's own reflectance
    /// What the albedo gains where light that is not totally reflected is reflected instead of transmitted:
    /// all of it, and the share that Fresnel's curve reflects.
    float exchange_all = 0, exchange_fresnel = 0;

    static Node mix(float t, const Node& a, const Node& b);
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
