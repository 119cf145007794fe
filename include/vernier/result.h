// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

// What is known of a render: how far it is, how wrong its picture is, and what that picture leaves out.

namespace vernier {

/// How wrong a picture probably is, without a reference. docs/error.md says what the figures mean and how
/// they are verified.
struct ErrorEstimate {
  /// Relative RMSE of the image, sqrt(mean((x - r)^2 / (r^2 + 0.01))) over channels and the pixels in which a
  /// sample met a surface (all, where none did), x the image and r the truth, with the ends of a 95 %
  /// interval for the error that this very image has. Of a transparent image, x is multiplied by alpha. Not a
  /// number while some pixel lacks a sample in either half.
  double rel_rmse = 0, low = 0, high = 0;
  /// Part of these pixels whose error figure is not to be trusted: too few samples, or most of what is known
  /// of them comes from too few.
  double unreliable = 0;
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

/// Rays cast, by purpose.
struct RayCounts {
  uint64_t camera = 0, bounce = 0, shadow = 0;

  RayCounts& operator+=(const RayCounts& other) {
    camera += other.camera;
    bounce += other.bounce;
    shadow += other.shadow;
    return *this;
  }
};

/// What ended a render.
enum class StopReason { samples, time, error, interrupted };

/// A render on its way.
struct RenderProgress {
  double seconds = 0;
  double fraction = 0;  ///< of what was asked for, by the limit that is nearest; in [0, 1]
  double samples_per_pixel = 0;
  uint64_t samples = 0;  ///< camera samples in total
  RayCounts rays;
  std::optional<ErrorEstimate> error;  ///< as of the last pass after which it was looked at
};

/// A render as far as it has come.
struct RenderStatus {
  double seconds = 0;  ///< of rendering
  double samples_per_pixel = 0;
  uint64_t samples = 0;
  RayCounts rays;
  ErrorEstimate error;
  MissingEstimate missing;   ///< known bias, which `error` does not contain
  uint64_t bad_samples = 0;  ///< left out because they were not finite or were negative
};

}  // namespace vernier
