// SPDX-License-Identifier: Apache-2.0
#include "core/compare/bias_test.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <optional>

#include "core/base/parallel.h"
#include "vernier/error.h"

namespace vernier {
namespace {

double squared(double x) { return x * x; }

// Two-sided p-value of Student's t.
double student_p(double t, double degrees) {
  if (!std::isfinite(degrees)) return std::erfc(t / std::numbers::sqrt2);
  // Without Boost's default of working in long double, which is several times slower.
  using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  const boost::math::students_t_distribution<double, Policy> distribution(degrees);
  return 2 * boost::math::cdf(boost::math::complement(distribution, t));
}

// Smallest of `count` p-values to the p-value of that minimum.
double sidak(double smallest, int count) { return -std::expm1(count * std::log1p(-smallest)); }

// Sums of x - y and of its variance over pixels.
struct Sums {
  std::array<double, 3> difference{};
  std::array<double, 3> independent{};           // variance
  std::array<double, 3> common_x{}, common_y{};  // standard errors of pixels that err together
  // Sum of squared variances over their degrees of freedom, for Welch and Satterthwaite's formula.
  std::array<double, 3> spread_of_variance{};
  int64_t pixels = 0;

  void add_pixel(const MeasuredImage& x, const MeasuredImage& y, size_t at);
  void add(const Sums& other);
  double variance(size_t c) const { return independent[c] + squared(common_x[c]) + squared(common_y[c]); }
  double p_value() const;
};

void Sums::add_pixel(const MeasuredImage& x, const MeasuredImage& y, size_t at) {
  ++pixels;
  for (size_t c = 0; c < 3; ++c, ++at) {
    const auto add_error = [&](const MeasuredImage& image, double& common) {
      const double error = image.error.values[at], squared_error = squared(error);
      if (image.errs_together) {
        common += error;
      } else {
        independent[c] += squared_error;
        spread_of_variance[c] += squared(squared_error) / image.degrees;
      }
    };
    add_error(x, common_x[c]);
    add_error(y, common_y[c]);
    const double apart = double(x.mean.values[at]) - y.mean.values[at];
    const double largest = std::max(std::abs(x.mean.values[at]), std::abs(y.mean.values[at]));
    const double rounding = 2 * largest * std::numeric_limits<float>::epsilon();
    difference[c] += std::copysign(std::max(0.0, std::abs(apart) - rounding), apart);
  }
}

void Sums::add(const Sums& other) {
  pixels += other.pixels;
  for (size_t c = 0; c < 3; ++c) {
    difference[c] += other.difference[c];
    independent[c] += other.independent[c];
    common_x[c] += other.common_x[c];
    common_y[c] += other.common_y[c];
    spread_of_variance[c] += other.spread_of_variance[c];
  }
}

// That the expectation of every channel's difference is zero.
double Sums::p_value() const {
  double smallest = 1;
  for (size_t c = 0; c < 3; ++c) {
    if (difference[c] == 0) continue;
    if (variance(c) == 0) return 0;
    const double degrees = squared(variance(c)) / spread_of_variance[c];  // infinite for sure errors
    smallest = std::min(smallest, student_p(std::abs(difference[c]) / std::sqrt(variance(c)), degrees));
  }
  return sidak(smallest, 3);
}

bool is_finite_pixel(const MeasuredImage& x, const MeasuredImage& y, size_t at) {
  for (const Image* image : {&x.mean, &x.error, &y.mean, &y.error})
    for (size_t c = 0; c < 3; ++c)
      if (!std::isfinite(image->values[at + c])) return false;
  return true;
}

bool is_unreliable(const MeasuredImage& image, int column, int row) {
  return image.unreliable && *image.unreliable->pixel(column, row) != 0;
}

// One row of blocks.
struct BlockRow {
  std::vector<Sums> blocks;
  Sums all;  // pixels not to be trusted included
  int64_t not_finite = 0, unreliable = 0;

  BlockRow(const MeasuredImage& x, const MeasuredImage& y, int top, int block)
      : blocks(size_t((x.mean.width + block - 1) / block)) {
    for (int row = top; row < std::min(top + block, x.mean.height); ++row)
      for (int column = 0; column < x.mean.width; ++column) {
        const size_t at = size_t(x.mean.pixel(column, row) - x.mean.values.data());
        if (!is_finite_pixel(x, y, at)) {
          ++not_finite;
          continue;
        }
        all.add_pixel(x, y, at);
        if (is_unreliable(x, column, row) || is_unreliable(y, column, row))
          ++unreliable;
        else
          blocks[size_t(column / block)].add_pixel(x, y, at);
      }
  }
};

// How many of the p-values Benjamini and Hochberg's procedure rejects.
int64_t count_rejected(std::vector<double> p_values, double level) {
  std::sort(p_values.begin(), p_values.end());
  for (size_t i = p_values.size(); i-- > 0;)
    if (p_values[i] <= level * double(i + 1) / double(p_values.size())) return int64_t(i + 1);
  return 0;
}

void check(const MeasuredImage& x, const MeasuredImage& y) {
  for (const Image* image : {&x.mean, &x.error, &y.mean, &y.error})
    if (image->width != x.mean.width || image->height != x.mean.height || image->channels != 3)
      throw Error(ErrorKind::usage,
                  "pictures and error layers to test for bias need one size and three channels");
  for (const Image* image : {x.unreliable, y.unreliable})
    if (image && (image->width != x.mean.width || image->height != x.mean.height || image->channels != 1))
      throw Error(ErrorKind::usage,
                  "the layer of unreliable pixels needs the picture's size and one channel");
}

}  // namespace

BiasTest test_bias(const MeasuredImage& x, const MeasuredImage& y, double level, int block) {
  check(x, y);
  const size_t count = size_t((x.mean.height + block - 1) / block);
  std::vector<std::optional<BlockRow>> rows(count);
  parallel_for(count, [&](size_t row) { rows[row].emplace(x, y, int(row) * block, block); });

  BiasTest result;
  result.level = level;
  result.block = block;
  std::vector<double> p_values;
  Sums total;
  for (size_t row = 0; row < count; ++row) {
    total.add(rows[row]->all);
    result.not_finite += rows[row]->not_finite;
    result.unreliable += rows[row]->unreliable;
    for (size_t column = 0; column < rows[row]->blocks.size(); ++column) {
      const Sums& sums = rows[row]->blocks[column];
      if (sums.pixels == 0) continue;
      const double p = sums.p_value();
      p_values.push_back(p);
      if (p >= result.smallest_p) continue;
      result.smallest_p = p;
      result.worst_x = int(column) * block;
      result.worst_y = int(row) * block;
    }
  }
  result.tested = int64_t(p_values.size());
  if (total.pixels == 0) return result;
  for (size_t c = 0; c < 3; ++c) {
    result.mean_difference[c] = total.difference[c] / double(total.pixels);
    result.mean_error[c] = std::sqrt(total.variance(c)) / double(total.pixels);
  }
  result.mean_p = total.p_value();
  result.differing = count_rejected(std::move(p_values), level);
  return result;
}

}  // namespace vernier
