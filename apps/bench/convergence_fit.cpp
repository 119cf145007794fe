// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/convergence_fit.h"

#include <algorithm>
#include <cmath>

namespace vernier::apps {
namespace {

double slope_between(const ErrorAt& a, const ErrorAt& b) {
  return std::log(b.error / a.error) / std::log(b.seconds / a.seconds);
}

double fitted_slope(const std::vector<ErrorAt>& points) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = double(points.size());
  for (const ErrorAt& p : points) {
    const double x = std::log(p.seconds), y = std::log(p.error);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// Sets floor and variance: linear in floor^2 and variance, residuals in units of error^2.
void fit_floor(const std::vector<ErrorAt>& points, ConvergenceFit& fit) {
  double aa = 0, ab = 0, bb = 0, a1 = 0, b1 = 0;
  for (const ErrorAt& p : points) {
    const double a = 1 / (p.error * p.error), b = a / p.seconds;
    aa += a * a;
    ab += a * b;
    bb += b * b;
    a1 += a;
    b1 += b;
  }
  const double determinant = aa * bb - ab * ab;
  const double floor_squared = (a1 * bb - b1 * ab) / determinant;
  if (floor_squared > 0) {
    fit.floor = std::sqrt(floor_squared);
    fit.variance = std::max(0.0, (b1 * aa - a1 * ab) / determinant);
  } else {
    fit.variance = b1 / bb;
  }
}

}  // namespace

std::optional<ConvergenceFit> fit_convergence(const std::vector<ErrorAt>& points) {
  const auto usable = [](const ErrorAt& p) { return p.seconds > 0 && p.error > 0 && std::isfinite(p.error); };
  if (points.size() < 2 || !std::all_of(points.begin(), points.end(), usable)) return {};
  ConvergenceFit fit;
  fit.slope = fitted_slope(points);
  fit.last_slope = slope_between(points[points.size() - 2], points.back());
  fit_floor(points, fit);
  return fit;
}

std::optional<TimeToReach> time_to_reach(double error, const std::vector<ErrorAt>& points,
                                         const ConvergenceFit& fit) {
  for (size_t i = 1; i < points.size(); ++i) {
    const ErrorAt &a = points[i - 1], &b = points[i];
    if (a.error < error || b.error > error) continue;
    const double place = a.error > b.error ? std::log(error / a.error) / std::log(b.error / a.error) : 0;
    return TimeToReach{a.seconds * std::pow(b.seconds / a.seconds, place), true};
  }
  const double falling = error * error - fit.floor * fit.floor;
  if (!(falling > 0)) return {};
  return TimeToReach{fit.variance / falling, false};
}

}  // namespace vernier::apps
