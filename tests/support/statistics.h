// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>

// Hypothesis tests. Each p-value is the probability of data at least this far off when the code is right.
// Seeds are fixed, so a test that passes once passes always; the significance levels say how often an honest
// change of random numbers would fail it.

namespace vernier::test {

/// Running mean and variance (Welford 1962).
class Samples {
 public:
  void add(double x) {
    ++count_;
    const double delta = x - mean_;
    mean_ += delta / double(count_);
    squares_ += delta * (x - mean_);
  }

  uint64_t count() const { return count_; }
  double mean() const { return mean_; }
  /// Unbiased; zero below two samples.
  double variance() const { return count_ > 1 ? squares_ / double(count_ - 1) : 0; }
  double standard_error() const;

 private:
  uint64_t count_ = 0;
  double mean_ = 0, squares_ = 0;
};

/// Two-sided Student's t-test that the mean is `expected`.
double mean_p_value(const Samples& samples, double expected);

/// Two-sided Welch's t-test that two means are equal (Welch 1947).
double welch_p_value(const Samples& a, const Samples& b);

/// Pearson's chi-square goodness of fit. Cells are pooled in order of expectation until each pool expects at
/// least five. Five samples or more where nothing at all is expected give 0;
/// fewer may be in a sliver of a cell that the integration of the expectation did not see.
double chi_square_p_value(std::span<const double> observed, std::span<const double> expected);

/// Significance of each of `count` tests such that the family has `family` (Sidak 1967).
double sidak(double family, size_t count);

/// Bias that a test of significance `family` finds nine times in ten, for a standard error `standard_error`
/// of the difference: (z_{1 - family / 2} + z_{0.9}) times it.
double detectable_bias(double standard_error, double significance);

/// Runs `p_value(seed, samples)`; when that is below `significance`, once more with another seed and 16 times
/// the samples, so that a false alarm has probability significance^2 and a real fault shows more clearly.
/// True when either run passes.
bool confirmed(double significance, uint64_t samples,
               const std::function<double(uint64_t seed, uint64_t samples)>& p_value);

/// What several comparisons are made with, measured once for each seed and number of samples that `confirmed`
/// asks for.
template <typename Result>
class Baseline {
 public:
  using Measure = std::function<Result(uint64_t seed, uint64_t samples)>;
  explicit Baseline(Measure measure) : measure_(std::move(measure)) {}

  const Result& operator()(uint64_t seed, uint64_t samples) {
    auto known = results_.find({seed, samples});
    if (known == results_.end())
      known = results_.emplace(std::pair(seed, samples), measure_(seed, samples)).first;
    return known->second;
  }

 private:
  Measure measure_;
  std::map<std::pair<uint64_t, uint64_t>, Result> results_;
};

}  // namespace vernier::test
