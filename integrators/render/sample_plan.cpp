// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/sample_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"

namespace vernier {
namespace {

/// What SamplePlan::Numbers can hold.
constexpr double max_count = 65535;

/// Pixels that one task looks at. Sums are rounded by these and not by the threads there are.
constexpr size_t block_size = 1 << 14;

/// Calls body(block, begin, end) for each block of `count` pixels, at once.
template <typename Body>
void for_each_block(size_t count, const Body& body) {
  parallel_for((count + block_size - 1) / block_size, [&](size_t block) {
    body(block, block * block_size, std::min(count, (block + 1) * block_size));
  });
}

/// Sums of value(i) over each block.
template <typename Value>
std::vector<double> block_sums(size_t count, const Value& value) {
  std::vector<double> sums((count + block_size - 1) / block_size);
  for_each_block(count, [&](size_t block, size_t begin, size_t end) {
    double sum = 0;
    for (size_t i = begin; i < end; ++i) sum += value(i);
    sums[block] = sum;
  });
  return sums;
}

template <typename Value>
double sum(size_t count, const Value& value) {
  const std::vector<double> sums = block_sums(count, value);
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// Samples of one half in a pass of `size` samples a pixel, by the other half's guide.
class NeymanAllocation {
 public:
  NeymanAllocation(const SamplesDrawn& drawn, int which, const SampleStatistics& guide, uint32_t size)
      : drawn_(drawn),
        which_(which),
        weights_(guide.error_weights()),
        budget_(size / 2.0 * double(weights_.size())) {
    done_sum_ = sum(weights_.size(), [&](size_t i) { return done(i); });
    weight_sum_ = sum(weights_.size(), [&](size_t i) { return weights_[i]; });
    const double weighted = sum(weights_.size(), [&](size_t i) { return weights_[i] > 0; });
    const double calm = double(weights_.size()) - weighted;
    min_ = std::floor(size * SamplePlan::guiding_part / 2);
    // At most eight times the even share, so that a plan made on little evidence does not spend everything;
    // up to 64 times where so few pixels need samples that the rest would have no place.
    const double all = weighted > 0 ? (budget_ - calm * min_) / weighted : 0;
    max_ = std::min(std::clamp(all, size * 4.0, size * 32.0), max_count);
    calm_ = calm > 0 ? std::max(min_, (budget_ - weighted * max_) / calm) : min_;
  }

  /// Sets this half's counts, on average half of `size`.
  void fill(std::vector<uint16_t>& counts) const {
    const double factor = solve_budget();
    // Fractions are carried along the row of pixels so that the total is met; how much comes into a block is
    // known from the sums over those before.
    std::vector<double> carried =
        block_sums(weights_.size(), [&](size_t i) { return target_count(i, factor) - min_; });
    std::exclusive_scan(carried.begin(), carried.end(), carried.begin(), 0.0);
    for_each_block(weights_.size(), [&](size_t block, size_t begin, size_t end) {
      double rest = carried[block] - std::floor(carried[block]);
      for (size_t i = begin; i < end; ++i) {
        rest += target_count(i, factor) - min_;
        const double whole = std::floor(rest);
        rest -= whole;
        counts[i * Film::halves + size_t(which_)] = uint16_t(std::min(min_ + whole, max_count));
      }
    });
  }

 private:
  /// Samples that the half has.
  double done(size_t i) const {
    return drawn_.guiding[size_t(which_)] + drawn_.extra[i * Film::halves + size_t(which_)];
  }

  /// The best total of a pixel is in proportion to its need (Neyman allocation). Where that has been passed
  /// already, or the bounds bite, the samples go elsewhere, by way of the factor.
  double target_count(size_t i, double factor) const {
    return weights_[i] > 0 ? std::clamp(factor * weights_[i] - done(i), min_, max_) : calm_;
  }

  /// The factor that spends the budget, to a thousandth. Steps in proportion find it in a few rounds, unless
  /// the need is that of few pixels; then it is bracketed and halved.
  double solve_budget() const {
    double factor = (done_sum_ + budget_) / weight_sum_, below = 0, above = 0;
    for (int round = 0; round < 200; ++round) {
      const double spent = sum(weights_.size(), [&](size_t i) { return target_count(i, factor); });
      if (std::abs(spent - budget_) < 0.001 * budget_) break;
      (spent < budget_ ? below : above) = factor;
      if (round < 20)
        factor *= std::clamp(1 + (budget_ - spent) / (done_sum_ + budget_), 0.5, 2.0);
      else
        factor = above > 0 ? (below + above) / 2 : 2 * factor;
    }
    return factor;
  }

  const SamplesDrawn& drawn_;
  const int which_;
  const std::vector<float> weights_;
  double budget_;  ///< samples to spend
  double min_ = 0, max_ = 0;
  double calm_ = 0;  ///< of a pixel that needs none
  double done_sum_ = 0, weight_sum_ = 0;
};

}  // namespace

float SampleStatistics::squared_error_weight(const Cell& cell) {
  if (cell.count < 2) return 0;
  const Rgb mean = cell.sum / float(cell.count), squared = variance(cell);
  float relative = 0;
  for (int c = 0; c < 3; ++c) relative += std::max(0.f, squared[c]) / (mean[c] * mean[c] + 0.01f);
  return std::isfinite(relative) ? relative : 0;  // squares of very bright samples are beyond float
}

bool SampleStatistics::is_plausible() const {
  return std::all_of(cells_.begin(), cells_.end(), [](const Cell& cell) {
    bool plausible = true;
    for (int c = 0; c < 3; ++c) plausible = plausible && cell.sum[c] >= 0 && cell.sum_of_squares[c] >= 0;
    return plausible;
  });
}

std::vector<float> SampleStatistics::error_weights() const {
  std::vector<float> raw(cells_.size()), smooth(cells_.size());
  parallel_for(cells_.size(), [&](size_t i) { raw[i] = squared_error_weight(cells_[i]); });
  parallel_for(size_t(height_), [&](size_t row) {
    const int y = int(row);
    for (int x = 0; x < width_; ++x) {
      float sum = 0;
      int count = 0;
      for (int j = std::max(0, y - 1); j <= std::min(height_ - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(width_ - 1, x + 1); ++i, ++count)
          sum += raw[size_t(j) * width_ + i];
      smooth[row * width_ + x] = std::sqrt(sum / float(count));
    }
  });
  return smooth;
}

size_t SamplePlan::planning_bytes_per_pixel() { return SampleStatistics::error_weights_bytes_per_pixel(); }

SamplePlan SamplePlan::uniform(const SamplesDrawn& drawn, uint32_t size) {
  Numbers plan;
  plan.size = size;
  // An odd sample goes to the half that has fewer.
  plan.odd_half = drawn.guiding[1] < drawn.guiding[0] ? 1 : 0;
  return SamplePlan(std::move(plan));
}

SamplePlan SamplePlan::adaptive(const SamplesDrawn& drawn,
                                std::span<const SampleStatistics, Film::halves> guides, uint32_t size) {
  Numbers plan;
  plan.width = guides[0].width();
  plan.size = size;
  plan.guiding = uint32_t(size * guiding_part / 2);
  plan.counts.resize(drawn.extra.size());
  for (int half = 0; half < Film::halves; ++half)
    NeymanAllocation(drawn, half, guides[size_t(1 - half)], size).fill(plan.counts);
  return SamplePlan(std::move(plan));
}

}  // namespace vernier
