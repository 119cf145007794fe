// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "integrators/integrator.h"

namespace vernier {

/// Sums over samples of a part of a picture: what they found, and what they know they left out.
struct TileLight {
  Rgb found{0, 0, 0};
  MissingLight missing;
  uint32_t samples = 0;

  void add(const Estimate& estimate) {
    found += estimate.radiance;
    missing += estimate.missing;
    ++samples;
  }
  bool is_plausible() const {
    return is_finite(found) && is_finite(missing.bent) && is_finite(missing.depth);
  }
  TileLight& operator+=(const TileLight& other) {
    found += other.found;
    missing += other.missing;
    samples += other.samples;
    return *this;
  }
};

/// How much light of one kind a picture leaves out.
struct MissingFigure {
  double share = 0;  ///< of all light, found and missing, by luminance
  /// Relative RMS of what is missing over tiles, in the unit of ErrorEstimate::rel_rmse: at least the error
  /// that it makes by itself, but for what evens out within a tile.
  double rel_rmse = 0;
};

/// Bias that a picture is known to have, which its samples cannot show.
struct MissingEstimate {
  MissingFigure bent;   ///< light of lamps through glass that bends it: at most
  MissingFigure depth;  ///< paths longer than the depth limit
};

/// Of tiles whose samples are spread evenly over their pixels.
MissingEstimate estimate_missing(std::span<const TileLight> tiles);

}  // namespace vernier
