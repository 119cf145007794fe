// SPDX-License-Identifier: Apache-2.0
#include "core/film/error_estimate.h"

#include <limits>

#include "core/base/parallel.h"
#include "core/compare/metrics.h"
#include "core/film/pixel_reliability.h"

namespace vernier {
namespace {

constexpr double doubtful_share = 1.0 / 3;  // of a pixel's light in one sample

/// The mean of relative_squared() over truths between `low` and `high`, each as likely as the others.
double relative_to_range(double squared, double low, double high) {
  static const double root = std::sqrt(relative_error_epsilon);
  if (high - low < 1e-3 * (low + root)) return relative_squared(squared, low);
  return squared * (std::atan(high / root) - std::atan(low / root)) / (root * (high - low));
}

/// Sum over pixels of squared relative errors, and of their squares.
struct RelativeSums {
  double sum = 0, squares = 0;

  void add(double value) {
    sum += value;
    squares += value * value;
  }
  void add(const RelativeSums& other) {
    sum += other.sum;
    squares += other.squares;
  }
  double mean(double n) const { return sum / n; }
  /// Half the width of a 95 % interval for the logarithm of the mean that the image has, around the estimated
  /// one: pixels are independent, and the image's own errors scatter as much as the differences of its
  /// halves.
  double log_margin(double n) const {
    if (sum <= 0) return 0;
    const double variance = std::max(0.0, squares / n - square(sum / n)) / std::max(1.0, n - 1);
    return 1.96 * std::sqrt(2 * variance) / mean(n);
  }
};

/// Sums over one row of pixels. A pixel that owes much of its light to one sample shows either a fluke, and
/// the truth is about what its surroundings say, or light that is seldom found, and the truth is nearer to
/// what it shows: the sample cannot tell. `most` takes the first, `least` the second, `likely` the mean over
/// what is between.
struct RowSums {
  RelativeSums least, likely, most;
  size_t unreliable = 0, pixels = 0;
  bool complete = true;

  void add_pixel(const Film& film, const PixelReliability& reliability, int x, int y);
  void add(const RowSums& other) {
    least.add(other.least);
    likely.add(other.likely);
    most.add(other.most);
    unreliable += other.unreliable;
    pixels += other.pixels;
    complete = complete && other.complete;
  }
};

void RowSums::add_pixel(const Film& film, const PixelReliability& reliability, int x, int y) {
  const Vec3d squared = squared_half_difference(film, x, y), shown = film.pixel(x, y);
  const bool doubtful = film.largest_share(x, y) > doubtful_share;
  double small = 0, middle = 0, large = 0;
  for (int c = 0; c < 3; ++c) {
    const double low = reliability.shrunk_mean.pixel(x, y)[c],
                 high = doubtful ? std::max(low, shown[c]) : low;
    small += relative_squared(squared[c], high) / 3;
    middle += relative_to_range(squared[c], low, high) / 3;
    large += relative_squared(squared[c], low) / 3;
  }
  least.add(small);
  likely.add(middle);
  most.add(large);
  unreliable += *reliability.unreliable.pixel(x, y) != 0;
  ++pixels;
}

/// Sums over the pixels that count: those that show a surface, or all where none does. (A plain background is
/// without error, and the more of it there is, the less would be told of what stands before it.)
RowSums sum_pixels(const Film& film, const PixelReliability& reliability, bool covered_only) {
  std::vector<RowSums> rows(size_t(film.height()));
  parallel_for(rows.size(), [&](size_t y) {
    for (int x = 0; x < film.width(); ++x) {
      const bool is_sampled = film.samples(x, int(y), 0) > 0 && film.samples(x, int(y), 1) > 0;
      rows[y].complete = rows[y].complete && is_sampled;
      if (!covered_only || film.is_covered(x, int(y))) rows[y].add_pixel(film, reliability, x, int(y));
    }
  });
  RowSums total;
  for (const RowSums& row : rows) total.add(row);
  return total;
}

}  // namespace

size_t estimate_error_bytes_per_pixel() { return assess_pixels_bytes_per_pixel(); }

ErrorEstimate estimate_error(const Film& film) {
  const PixelReliability reliability = assess_pixels(film);
  RowSums total = sum_pixels(film, reliability, true);
  if (total.pixels == 0) total = sum_pixels(film, reliability, false);
  const auto n = double(total.pixels);
  ErrorEstimate estimate;
  estimate.unreliable = double(total.unreliable) / n;
  if (!total.complete) {
    estimate.rel_rmse = estimate.low = estimate.high = std::numeric_limits<double>::quiet_NaN();
    return estimate;
  }
  estimate.rel_rmse = std::sqrt(total.likely.mean(n));
  estimate.low = std::sqrt(total.least.mean(n) * std::exp(-total.least.log_margin(n)));
  estimate.high = std::sqrt(total.most.mean(n) * std::exp(total.most.log_margin(n)));
  return estimate;
}

}  // namespace vernier
