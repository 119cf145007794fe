// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "integrators/integrator.h"
#include "vernier/result.h"

namespace vernier {

/// Sums over samples of a part of a picture: what they found, and what they know they left out.
struct TileLight {
  Rgb found{0, 0, 0};
  MissingLight missing;
  Rgb beyond{0, 0, 0};  ///< the depth limit: of all light paths, at its pixels
  uint32_t samples = 0;

  void add(const Estimate& estimate) {
    found += estimate.radiance;
    missing += estimate.missing;
    ++samples;
  }
  bool is_plausible() const {
    return is_finite(found) && is_finite(missing.bent) && is_finite(missing.depth) && is_finite(beyond);
  }
  TileLight& operator+=(const TileLight& other) {
    found += other.found;
    missing += other.missing;
    beyond += other.beyond;
    samples += other.samples;
    return *this;
  }
};

/// Of tiles whose samples are spread evenly over their pixels.
MissingEstimate estimate_missing(std::span<const TileLight> tiles);

}  // namespace vernier
