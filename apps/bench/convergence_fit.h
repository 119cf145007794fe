// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

namespace vernier::apps {

/// Error after some seconds of rendering.
struct ErrorAt {
  double seconds = 0, error = 0;
};

/// How error falls with time. Sampling alone gives error^2 = V / t: slope -1/2 on logarithmic axes; what does
/// not fall with time is bias.
struct ConvergenceFit {
  double slope = 0;       ///< least squares through the logarithms
  double last_slope = 0;  ///< between the last two points
  /// error^2 = floor^2 + variance / t, least squares of relative residuals; floor 0 where the curve does not
  /// flatten.
  double floor = 0, variance = 0;
};

/// Empty with fewer than two points or an error that is not positive.
std::optional<ConvergenceFit> fit_convergence(const std::vector<ErrorAt>& points);

struct TimeToReach {
  double seconds = 0;
  bool measured = false;  ///< between two points; else by the fit
};

/// When the error has fallen to `error`; empty when the curve flattens above it.
std::optional<TimeToReach> time_to_reach(double error, const std::vector<ErrorAt>& points,
                                         const ConvergenceFit& fit);

}  // namespace vernier::apps
