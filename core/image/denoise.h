#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "core/image/image.h"

namespace vernier {

/// A noisy picture and what is known of it; all of one size, three channels each. Layers that are absent
/// guide nothing.
struct NoisyImage {
  Image color;  ///< scene-linear Rec.709
  std::optional<Image> error =
      {};  ///< standard error of each value of `color`; estimated from `color` when absent
  std::optional<Image> albedo =
      {};  ///< reflectance: `color` is filtered divided by it, so that texture is kept
  std::optional<Image> normal = {};  ///< unit vectors: pixels that face elsewhere are not mixed
};

/// One line of the table of denoisers. `filter` is a pure function: equal input gives equal bits on any
/// number of threads. Values are in no way clamped; ones that are not finite, or beyond 1e18, are replaced by
/// their neighbours' mean first.
struct Denoiser {
  std::string_view name;
  std::string_view description;
  Image (*filter)(const NoisyImage&);
};

/// All denoisers this build has.
std::span<const Denoiser> denoisers();

/// A picture denoised as two halves, so that its own error, what the filter blurs included, is known.
struct DenoisedHalves {
  Image picture;              ///< mean of the two filtered halves
  double noisy_rel_rmse = 0;  ///< of the mean of the halves as they were
  /// Of `picture`, with the ends of a 95 % interval.
  double rel_rmse = 0, low = 0, high = 0;
};

/// Filters each half by itself. Each filtered half is compared with the other half unfiltered, which knows
/// nothing of it: the expectation of their squared difference is the first's squared error plus the second's
/// variance. Errors are relative as in core/image/error_estimate.h, sqrt(mean((x - r)^2 / (r^2 + 0.01))),
/// with the median of the noisy 3 x 3 about the pixel for r. The halves must be independent and unbiased, and
/// each half's error layer must come from that half alone; albedo and normal may be shared. Throws
/// Error(usage) when sizes differ.
DenoisedHalves denoise_halves(const Denoiser& denoiser, const NoisyImage& first, const NoisyImage& second);

}  // namespace vernier
