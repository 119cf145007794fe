#include "core/image/bias_test.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>

#include "core/base/error.h"
#include "core/base/parallel.h"

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

struct Sums {
  std::array<double, 3> difference{}, variance{};
  int64_t not_finite = 0;
};

// p-value of one channel of one pixel; adds to the picture's sums.
double channel_p(const MeasuredImage& x, const MeasuredImage& y, size_t at, int c, Sums& sums) {
  const double vx = squared(double(x.error.values[at])), vy = squared(double(y.error.values[at]));
  const double difference = double(x.mean.values[at]) - y.mean.values[at];
  const double largest = std::max(std::abs(x.mean.values[at]), std::abs(y.mean.values[at]));
  const double rounding = 2 * largest * std::numeric_limits<float>::epsilon();
  const double beyond = std::max(0.0, std::abs(difference) - rounding);
  sums.difference[size_t(c)] += std::copysign(beyond, difference);
  sums.variance[size_t(c)] += vx + vy;
  if (beyond == 0) return 1;
  if (vx + vy == 0) return 0;
  // Welch and Satterthwaite's degrees of freedom.
  const double degrees = squared(vx + vy) / (squared(vx) / x.degrees + squared(vy) / y.degrees);
  return student_p(beyond / std::sqrt(vx + vy), degrees);
}

// p-values of one row, 2 for a pixel that is not tested.
std::vector<double> row_p_values(const MeasuredImage& x, const MeasuredImage& y, int row, Sums& sums) {
  std::vector<double> p_values;
  for (int column = 0; column < x.mean.width; ++column) {
    const size_t at = size_t(x.mean.pixel(column, row) - x.mean.values.data());
    bool finite = true;
    for (const Image* image : {&x.mean, &x.error, &y.mean, &y.error})
      for (size_t c = 0; c < 3; ++c) finite = finite && std::isfinite(image->values[at + c]);
    double smallest = 2;
    if (finite) {
      for (int c = 0; c < 3; ++c) smallest = std::min(smallest, channel_p(x, y, at + size_t(c), c, sums));
      smallest = sidak(smallest, 3);
    } else {
      ++sums.not_finite;
    }
    p_values.push_back(smallest);
  }
  return p_values;
}

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
}

}  // namespace

BiasTest test_bias(const MeasuredImage& x, const MeasuredImage& y, double level) {
  check(x, y);
  const size_t height = size_t(x.mean.height);
  std::vector<Sums> sums(height);
  std::vector<std::vector<double>> rows(height);
  parallel_for(height, [&](size_t row) { rows[row] = row_p_values(x, y, int(row), sums[row]); });

  BiasTest result;
  result.level = level;
  std::vector<double> p_values;
  Sums total;
  for (size_t row = 0; row < height; ++row) {
    for (size_t c = 0; c < 3; ++c) {
      total.difference[c] += sums[row].difference[c];
      total.variance[c] += sums[row].variance[c];
    }
    result.not_finite += sums[row].not_finite;
    for (size_t column = 0; column < rows[row].size(); ++column) {
      const double p = rows[row][column];
      if (p > 1) continue;
      p_values.push_back(p);
      if (p >= result.smallest_p) continue;
      result.smallest_p = p;
      result.worst_x = int(column);
      result.worst_y = int(row);
    }
  }
  result.tested = int64_t(p_values.size());
  if (p_values.empty()) return result;
  for (size_t c = 0; c < 3; ++c) {
    result.mean_difference[c] = total.difference[c] / double(result.tested);
    result.mean_error[c] = std::sqrt(total.variance[c]) / double(result.tested);
    if (result.mean_difference[c] == 0) continue;
    const double z =
        std::abs(result.mean_difference[c]) / result.mean_error[c];  // infinite for exact pictures
    result.mean_p = std::min(result.mean_p, student_p(z, std::numeric_limits<double>::infinity()));
  }
  result.mean_p = sidak(result.mean_p, 3);
  result.differing = count_rejected(std::move(p_values), level);
  return result;
}

}  // namespace vernier
