// SPDX-License-Identifier: Apache-2.0
#include "tests/support/statistics.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <vector>

namespace vernier::test {
namespace {

double two_sided_t(double difference, double standard_error, double degrees) {
  if (!std::isfinite(difference) || !std::isfinite(standard_error)) return 0;
  if (standard_error == 0) return difference == 0 ? 1 : 0;
  const boost::math::students_t t(degrees);
  return 2 * boost::math::cdf(boost::math::complement(t, std::abs(difference / standard_error)));
}

}  // namespace

double Samples::standard_error() const { return count_ > 0 ? std::sqrt(variance() / double(count_)) : 0; }

double mean_p_value(const Samples& samples, double expected) {
  return two_sided_t(samples.mean() - expected, samples.standard_error(), double(samples.count() - 1));
}

double welch_p_value(const Samples& a, const Samples& b) {
  const double va = a.variance() / double(a.count()), vb = b.variance() / double(b.count());
  const double sum = va + vb;
  // Welch and Satterthwaite's degrees of freedom.
  const double degrees =
      sum > 0 ? sum * sum / (va * va / double(a.count() - 1) + vb * vb / double(b.count() - 1)) : 1;
  return two_sided_t(a.mean() - b.mean(), std::sqrt(sum), degrees);
}

double chi_square_p_value(std::span<const double> observed, std::span<const double> expected) {
  constexpr double least_expected = 5;
  std::vector<size_t> order(expected.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });

  double impossible = 0;
  double statistic = 0, pooled_observed = 0, pooled_expected = 0;
  int pools = 0;
  const auto close_pool = [&] {
    const double difference = pooled_observed - pooled_expected;
    statistic += difference * difference / pooled_expected;
    pooled_observed = pooled_expected = 0;
    ++pools;
  };
  for (const size_t cell : order) {
    if (!(expected[cell] >= 0)) return 0;
    if (expected[cell] == 0) impossible += observed[cell];
    pooled_observed += observed[cell];
    pooled_expected += expected[cell];
    if (pooled_expected >= least_expected) close_pool();
  }
  // What is left expects less than five; it counts as a pool of its own, which errs on the side of failing.
  if (pooled_expected > 0) close_pool();
  if (impossible >= least_expected) return 0;
  if (pools < 2) return 1;
  const boost::math::chi_squared distribution(pools - 1);
  return boost::math::cdf(boost::math::complement(distribution, statistic));
}

double sidak(double family, size_t count) { return 1 - std::pow(1 - family, 1 / double(count)); }

double detectable_bias(double standard_error, double significance) {
  const boost::math::normal z;
  return (boost::math::quantile(boost::math::complement(z, significance / 2)) +
          boost::math::quantile(z, 0.9)) *
         standard_error;
}

bool confirmed(double significance, uint64_t samples,
               const std::function<double(uint64_t seed, uint64_t samples)>& p_value) {
  if (p_value(1, samples) >= significance) return true;
  return p_value(2, 16 * samples) >= significance;
}

}  // namespace vernier::test
