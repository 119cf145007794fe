// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/distribution.h"

#include <algorithm>

namespace vernier {
namespace {

constexpr float one_minus_epsilon = 0x1.fffffep-1f;

/// What cumulative sums end at.
constexpr uint32_t whole = 0xffffffff;

double usable(float weight) { return std::isfinite(weight) && weight > 0 ? weight : 0; }

double sum_of(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum;
}

/// Writes running sums of `values`, none of them negative, scaled to end at `whole`, into `cumulative` (one
/// longer). Every positive value gets at least one unit, and zero gets none.
void accumulate(std::span<const double> values, std::span<uint32_t> cumulative) {
  const double sum = sum_of(values);
  const auto positive = std::count_if(values.begin(), values.end(), [](double v) { return v > 0; });
  const double scale = sum > 0 ? double(whole - uint32_t(positive)) / sum : 0;
  double running = 0;
  uint32_t units = 0;
  cumulative[0] = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    running += values[i];
    units += values[i] > 0;
    cumulative[i + 1] = units + uint32_t(std::min(running * scale, double(whole - uint32_t(positive))));
  }
  // Rounding may have ended the sum early; what is missing belongs to the last value that is not zero.
  if (sum > 0) std::replace(cumulative.begin() + 1, cumulative.end(), uint32_t(cumulative.back()), whole);
}

/// Probability of interval i.
double share(std::span<const uint32_t> cumulative, int i) {
  return double(cumulative[size_t(i) + 1] - cumulative[size_t(i)]) / whole;
}

/// The interval that u falls into, and its place in that.
struct Inverted {
  int index;
  float fraction;
};
Inverted invert(std::span<const uint32_t> cumulative, double u) {
  const double units = u * whole;
  // The ends are whole numbers, so that comparing the whole part of u is enough.
  const auto above = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, uint32_t(units));
  const auto index = size_t(above - cumulative.begin()) - 1;
  const double fraction = (units - cumulative[index]) / double(cumulative[index + 1] - cumulative[index]);
  return {int(index), std::min(float(fraction), one_minus_epsilon)};
}

}  // namespace

AliasTable::AliasTable(std::span<const float> weights) {
  for (const float w : weights) sum_ += usable(w);
  if (!(sum_ > 0)) return;
  const size_t n = weights.size();
  bins_.resize(n);
  std::vector<double> scaled(n);
  std::vector<uint32_t> small, large;
  for (size_t i = 0; i < n; ++i) {
    const double prob = usable(weights[i]) / sum_;
    bins_[i].prob = float(prob);
    bins_[i].alias = uint32_t(i);
    scaled[i] = prob * double(n);
    (scaled[i] < 1 ? small : large).push_back(uint32_t(i));
  }
  while (!small.empty() && !large.empty()) {
    const uint32_t s = small.back(), l = large.back();
    small.pop_back();
    bins_[s].threshold = scaled[s];
    bins_[s].alias = l;
    scaled[l] -= 1 - scaled[s];
    if (scaled[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
  const auto by_prob = [](const Bin& a, const Bin& b) { return a.prob < b.prob; };
  const auto likeliest = uint32_t(std::max_element(bins_.begin(), bins_.end(), by_prob) - bins_.begin());
  // What is left differs from 1 by rounding only, unless its weight is zero: that one must never be picked.
  for (const uint32_t s : small)
    if (bins_[s].prob == 0) {
      bins_[s].threshold = 0;
      bins_[s].alias = likeliest;
    }
}

size_t AliasTable::sample(double u) const {
  const double scaled = u * double(bins_.size());
  const size_t i = std::min(size_t(scaled), bins_.size() - 1);
  return scaled - double(i) < bins_[i].threshold ? i : bins_[i].alias;
}

Distribution2D::Distribution2D(std::span<const float> values, int columns, int rows)
    : columns_(columns),
      rows_(rows),
      conditional_((size_t(columns) + 1) * size_t(rows)),
      marginal_(size_t(rows) + 1) {
  std::vector<double> of_row(static_cast<size_t>(columns)), row_sums(static_cast<size_t>(rows));
  for (size_t y = 0; y < row_sums.size(); ++y) {
    const auto begin = values.begin() + ptrdiff_t(y * of_row.size());
    std::transform(begin, begin + ptrdiff_t(of_row.size()), of_row.begin(), usable);
    row_sums[y] = sum_of(of_row);
    accumulate(of_row, std::span(conditional_).subspan(y * (of_row.size() + 1), of_row.size() + 1));
  }
  accumulate(row_sums, marginal_);
  mean_ = sum_of(row_sums) / (double(columns) * rows);
}

Vec2f Distribution2D::sample(const Vec2d& u, float& pdf) const {
  const auto [y, dy] = invert(marginal_, u.y);
  const auto [x, dx] = invert(row(y), u.x);
  pdf = density(x, y);
  return {(float(x) + dx) / float(columns_), (float(y) + dy) / float(rows_)};
}

float Distribution2D::pdf(const Vec2f& p) const {
  if (empty()) return 0;
  const int column = std::clamp(int(p.x * float(columns_)), 0, columns_ - 1);
  const int row = std::clamp(int(p.y * float(rows_)), 0, rows_ - 1);
  return density(column, row);
}

float Distribution2D::density(int column, int row) const {
  return float(share(marginal_, row) * rows_ * (share(this->row(row), column) * columns_));
}

}  // namespace vernier
