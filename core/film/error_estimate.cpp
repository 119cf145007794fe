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

/// Sums over groups of pixels of squared relative errors: of those of each group, of the squares of these
/// sums, and of their products with how many pixels the groups have. Groups are single pixels where these are
/// independent of each other.
struct RelativeSums {
  double sum = 0, squares = 0, by_pixels = 0;

  void add_group(double value, double pixels) {
    sum += value;
    squares += value * value;
    by_pixels += value * pixels;
  }
  void add(const RelativeSums& other) {
    sum += other.sum;
    squares += other.squares;
    by_pixels += other.by_pixels;
  }
  double mean(double n) const { return sum / n; }
  /// Half the width of a 95 % interval for the logarithm of the mean that the image has, around the estimated
  /// one: groups are independent, and the image's own errors scatter as much as the differences of its
  /// halves. That of the ratio of two sums (Cochran 1977, "Sampling Techniques", chapter 6), over n pixels;
  /// `squared_sizes` is the sum over groups of their squared numbers of pixels.
  double log_margin(double n, double squared_sizes) const {
    if (sum <= 0) return 0;
    const double m = mean(n), deviations = squares - 2 * m * by_pixels + m * m * squared_sizes;
    const double variance = std::max(0.0, deviations) / (n * std::max(1.0, n - squared_sizes / n));
    return 1.96 * std::sqrt(2 * variance) / mean(n);
  }
};

/// Sums over a group of pixels. A pixel that owes much of its light to one sample shows either a fluke, and
/// the truth is about what its surroundings say, or light that is seldom found, and the truth is nearer to
/// what it shows: the sample cannot tell. `most` takes the first, `least` the second, `likely` the mean over
/// what is between.
struct GroupSums {
  double least = 0, likely = 0, most = 0;
  size_t unreliable = 0, pixels = 0;
  bool complete = true;

  void add_pixel(const Film& film, const PixelReliability& reliability, int x, int y);
};

/// Sums over groups.
struct Totals {
  RelativeSums least, likely, most;
  size_t unreliable = 0, pixels = 0;
  double squared_sizes = 0;  ///< of groups
  bool complete = true;

  void add(const GroupSums& group) {
    const auto size = double(group.pixels);
    least.add_group(group.least, size);
    likely.add_group(group.likely, size);
    most.add_group(group.most, size);
    unreliable += group.unreliable;
    pixels += group.pixels;
    squared_sizes += size * size;
    complete = complete && group.complete;
  }
  void add(const Totals& other) {
    least.add(other.least);
    likely.add(other.likely);
    most.add(other.most);
    unreliable += other.unreliable;
    pixels += other.pixels;
    squared_sizes += other.squared_sizes;
    complete = complete && other.complete;
  }
};

void GroupSums::add_pixel(const Film& film, const PixelReliability& reliability, int x, int y) {
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
  least += small;
  likely += middle;
  most += large;
  unreliable += *reliability.unreliable.pixel(x, y) != 0;
  ++pixels;
}

/// Side of the groups of pixels that are taken for independent of each other. A reconstruction ties the
/// errors of pixels that are some two apart; small pictures still have several groups.
int group_side(const Film& film) {
  return film.is_reconstructed() ? std::clamp(std::min(film.width(), film.height()) / 4, 1, 8) : 1;
}

/// Sums over the pixels that count: those that show a surface, or all where none does. (A plain background is
/// without error, and the more of it there is, the less would be told of what stands before it.)
Totals sum_pixels(const Film& film, const PixelReliability& reliability, bool covered_only) {
  const int side = group_side(film);
  std::vector<Totals> rows(size_t((film.height() + side - 1) / side));
  parallel_for(rows.size(), [&](size_t row) {
    const int y0 = int(row) * side, y1 = std::min(y0 + side, film.height());
    for (int x0 = 0; x0 < film.width(); x0 += side) {
      GroupSums group;
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < std::min(x0 + side, film.width()); ++x) {
          const bool is_sampled = film.samples(x, y, 0) > 0 && film.samples(x, y, 1) > 0;
          group.complete = group.complete && is_sampled;
          if (!covered_only || film.is_covered(x, y)) group.add_pixel(film, reliability, x, y);
        }
      rows[row].add(group);
    }
  });
  Totals total;
  for (const Totals& row : rows) total.add(row);
  return total;
}

}  // namespace

size_t estimate_error_bytes_per_pixel() { return assess_pixels_bytes_per_pixel(); }

ErrorEstimate estimate_error(const Film& film) {
  const PixelReliability reliability = assess_pixels(film);
  Totals total = sum_pixels(film, reliability, true);
  if (total.pixels == 0) total = sum_pixels(film, reliability, false);
  const auto n = double(total.pixels);
  ErrorEstimate estimate;
  estimate.unreliable = double(total.unreliable) / n;
  if (!total.complete) {
    estimate.rel_rmse = estimate.low = estimate.high = std::numeric_limits<double>::quiet_NaN();
    return estimate;
  }
  estimate.rel_rmse = std::sqrt(total.likely.mean(n));
  estimate.low = std::sqrt(total.least.mean(n) * std::exp(-total.least.log_margin(n, total.squared_sizes)));
  estimate.high = std::sqrt(total.most.mean(n) * std::exp(total.most.log_margin(n, total.squared_sizes)));
  return estimate;
}

}  // namespace vernier
