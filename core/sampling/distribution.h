#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/math/vec.h"

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
  size_t sample(float u) const;
  /// Probability of i.
  float prob(size_t i) const { return bins_[i].prob; }

 private:
  struct Bin {
    float threshold = 1, prob = 0;
    uint32_t alias = 0;
  };
  std::vector<Bin> bins_;
  double sum_ = 0;
};

/// Piecewise-constant density on [0,1)^2 over a grid of columns x rows, row 0 at y = 0. Inverts cumulative
/// sums, so that stratified points stay stratified.
class Distribution2D {
 public:
  Distribution2D() = default;
  /// values: row-major, at least columns * rows; negative and non-finite ones count as zero.
  Distribution2D(std::span<const float> values, int columns, int rows);

  /// Whether every value is zero.
  bool empty() const { return total_ == 0; }
  /// Mean of the values: the integral over the square.
  double integral() const { return total_; }

  /// A point, and its density in `pdf`.
  Vec2f sample(const Vec2f& u, float& pdf) const;
  float pdf(const Vec2f& p) const;

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<float> values_;
  std::vector<float> conditional_;  ///< per row: columns + 1 running sums, the last 1
  std::vector<float> marginal_;     ///< rows + 1
  double total_ = 0;
};

}  // namespace vernier
