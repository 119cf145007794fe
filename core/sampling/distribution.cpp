#include "core/sampling/distribution.h"

#include <algorithm>
#include <cstdint>

namespace vernier {
namespace {

constexpr float one_minus_epsilon = 0x1.fffffep-1f;

float usable(float weight) { return std::isfinite(weight) && weight > 0 ? weight : 0.f; }

/// Writes running sums of `values` scaled to end at 1 into `cumulative` (one longer); returns the unscaled
/// sum.
double accumulate(std::span<const float> values, std::span<float> cumulative) {
  double sum = 0;
  for (const float v : values) sum += v;
  double running = 0;
  cumulative[0] = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    running += values[i];
    cumulative[i + 1] = sum > 0 ? float(running / sum) : float(i + 1) / float(values.size());
  }
  cumulative.back() = 1;
  return sum;
}

/// Interval i with cumulative[i] <= u < cumulative[i+1], and the place of u in it.
struct Inverted {
  int index;
  float fraction;
};
Inverted invert(std::span<const float> cumulative, float u) {
  const auto above = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, u);
  const int index = int(above - cumulative.begin()) - 1;
  const float width = cumulative[index + 1] - cumulative[index];
  const float fraction = width > 0 ? (u - cumulative[index]) / width : 0.5f;
  return {index, std::clamp(fraction, 0.f, one_minus_epsilon)};
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
    bins_[s].threshold = float(scaled[s]);
    bins_[s].alias = l;
    scaled[l] -= 1 - scaled[s];
    if (scaled[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
  // What is left differs from 1 by rounding only, unless its weight is zero: that one must never be picked.
  for (const uint32_t s : small)
    if (bins_[s].prob == 0) {
      bins_[s].threshold = 0;
      bins_[s].alias = uint32_t(std::max_element(weights.begin(), weights.end()) - weights.begin());
    }
}

size_t AliasTable::sample(float u) const {
  const float scaled = u * float(bins_.size());
  const size_t i = std::min(size_t(scaled), bins_.size() - 1);
  return scaled - float(i) < bins_[i].threshold ? i : bins_[i].alias;
}

Distribution2D::Distribution2D(std::span<const float> values, int columns, int rows)
    : columns_(columns),
      rows_(rows),
      values_(size_t(columns) * rows),
      conditional_(size_t(columns + 1) * rows),
      marginal_(size_t(rows) + 1) {
  std::transform(values.begin(), values.begin() + ptrdiff_t(values_.size()), values_.begin(), usable);
  std::vector<float> row_sums(rows);
  for (int y = 0; y < rows; ++y)
    row_sums[y] = float(accumulate(std::span(values_).subspan(size_t(y) * columns, columns),
                                   std::span(conditional_).subspan(size_t(y) * (columns + 1), columns + 1)));
  total_ = accumulate(row_sums, marginal_) / double(values_.size());
  if (total_ > 0)
    for (float& v : values_) v = float(v / total_);
}

Vec2f Distribution2D::sample(const Vec2f& u, float& pdf) const {
  const auto [row, dy] = invert(marginal_, u.y);
  const auto [column, dx] =
      invert(std::span(conditional_).subspan(size_t(row) * (columns_ + 1), columns_ + 1), u.x);
  pdf = values_[size_t(row) * columns_ + column];
  return {(float(column) + dx) / float(columns_), (float(row) + dy) / float(rows_)};
}

float Distribution2D::pdf(const Vec2f& p) const {
  const int column = std::clamp(int(p.x * float(columns_)), 0, columns_ - 1);
  const int row = std::clamp(int(p.y * float(rows_)), 0, rows_ - 1);
  return values_[size_t(row) * columns_ + column];
}

}  // namespace vernier
