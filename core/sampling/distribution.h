// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vernier/math.h"

// Choices among weighted values. They take numbers of full double precision (Sampler::next1_fine()), since a
// weight may be a tiny part of the sum: what is drawn less often than float can tell has the probability that
// is told nevertheless.

namespace vernier {

/// Picks index i with probability weight_i / sum in constant time (Walker 1977; construction of Vose 1991).
class AliasTable {
 public:
  AliasTable() = default;
  /// Negative or non-finite weights count as zero. All zero: empty().
  explicit AliasTable(std::span<const float> weights);

  bool empty() const { return bins_.empty(); }
  size_t size() const { return bins_.size(); }
  double sum() const { return sum_; }

  /// u in [0, 1).
  size_t sample(double u) const;
  /// Probability of i.
  float prob(size_t i) const { return bins_[i].prob; }

 private:
  struct Bin {
    double threshold = 1;
    float prob = 0;
    uint32_t alias = 0;
  };
  std::vector<Bin> bins_;
  double sum_ = 0;
};

/// Piecewise-constant density on [0,1)^2 over a grid of columns x rows, row 0 at y = 0. Inverts cumulative
/// sums, so that stratified points stay stratified. The sums are whole numbers, and the density is told from
/// these: it is exactly that of the samples, for cells of any weight.
class Distribution2D {
 public:
  Distribution2D() = default;
  /// values: row-major, at least columns * rows; negative and non-finite ones count as zero.
  Distribution2D(std::span<const float> values, int columns, int rows);

  /// Whether every value is zero.
  bool empty() const { return mean_ == 0; }
  /// Mean of the values: the integral over the square.
  double integral() const { return mean_; }

  /// A point, and its density in `pdf`.
  Vec2f sample(const Vec2d& u, float& pdf) const;
  float pdf(const Vec2f& p) const;

 private:
  std::span<const uint32_t> row(int y) const {
    return std::span(conditional_).subspan(size_t(y) * (size_t(columns_) + 1), size_t(columns_) + 1);
  }
  float density(int column, int row) const;

  int columns_ = 0, rows_ = 0;
  std::vector<uint32_t> conditional_;  ///< per row: columns + 1 cumulative sums
  std::vector<uint32_t> marginal_;     ///< rows + 1
  double mean_ = 0;
};

}  // namespace vernier
