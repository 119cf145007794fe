// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/sample_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"

namespace vernier {
namespace {

/// What SamplePlan::Numbers can hold.
constexpr double most_countable = 65535;

/// Samples of one half in a pass of `size` samples a pixel, by the other half's guide.
class HalfPlan {
 public:
  HalfPlan(const SamplesDrawn& drawn, int which, const SampleGuide& guide, uint32_t size)
      : needs_(guide.needs()), done_(needs_.size()), budget_(size / 2.0 * double(needs_.size())) {
    size_t needy = 0;
    for (size_t i = 0; i < done_.size(); ++i) {
      done_[i] = drawn.guiding[size_t(which)] + drawn.extra[i * Film::halves + size_t(which)];
      done_sum_ += done_[i];
      need_sum_ += needs_[i];
      needy += needs_[i] > 0;
    }
    const auto calm = double(needs_.size() - needy);
    least_ = std::floor(size * SamplePlan::guiding_part / 2);
    // At most eight times the even share, so that a plan made on little evidence does not spend everything;
    // up to 64 times where so few pixels need samples that the rest would have no place.
    const double all = needy > 0 ? (budget_ - calm * least_) / double(needy) : 0;
    most_ = std::min(std::clamp(all, size * 4.0, size * 32.0), most_countable);
    calm_ = calm > 0 ? std::max(least_, (budget_ - double(needy) * most_) / calm) : least_;
  }

  static constexpr size_t bytes_per_pixel() {
    return sizeof(decltype(needs_)::value_type) + sizeof(decltype(done_)::value_type);
  }

  /// Sets this half's counts, on average half of `size`.
  void fill(std::vector<uint16_t>& counts, int which) const {
    const double factor = find_factor();
    // Fractions are carried along the row of pixels so that the total is met.
    double carried = 0;
    for (size_t i = 0; i < needs_.size(); ++i) {
      carried += wanted(i, factor) - least_;
      const double whole = std::floor(carried);
      carried -= whole;
      counts[i * Film::halves + size_t(which)] = uint16_t(std::min(least_ + whole, most_countable));
    }
  }

 private:
  /// The best total of a pixel is in proportion to its need (Neyman allocation). Where that has been passed
  /// already, or the bounds bite, the samples go elsewhere, by way of the factor.
  double wanted(size_t i, double factor) const {
    return needs_[i] > 0 ? std::clamp(factor * needs_[i] - done_[i], least_, most_) : calm_;
  }

  /// The factor that spends the budget, to a thousandth. Steps in proportion find it in a few rounds, unless
  /// the need is that of few pixels; then it is bracketed and halved.
  double find_factor() const {
    double factor = (done_sum_ + budget_) / need_sum_, below = 0, above = 0;
    for (int round = 0; round < 200; ++round) {
      double spent = 0;
      for (size_t i = 0; i < needs_.size(); ++i) spent += wanted(i, factor);
      if (std::abs(spent - budget_) < 0.001 * budget_) break;
      (spent < budget_ ? below : above) = factor;
      if (round < 20)
        factor *= std::clamp(1 + (budget_ - spent) / (done_sum_ + budget_), 0.5, 2.0);
      else
        factor = above > 0 ? (below + above) / 2 : 2 * factor;
    }
    return factor;
  }

  std::vector<float> needs_;
  std::vector<double> done_;  ///< samples that the half has
  double budget_;             ///< samples to spend
  double least_ = 0, most_ = 0;
  double calm_ = 0;  ///< of a pixel that needs none
  double done_sum_ = 0, need_sum_ = 0;
};

}  // namespace

float SampleGuide::squared_need(const Cell& cell) {
  if (cell.count < 2) return 0;
  const Rgb mean = cell.sum / float(cell.count), squared = variance(cell);
  float relative = 0;
  for (int c = 0; c < 3; ++c) relative += std::max(0.f, squared[c]) / (mean[c] * mean[c] + 0.01f);
  return std::isfinite(relative) ? relative : 0;  // squares of very bright samples are beyond float
}

bool SampleGuide::is_plausible() const {
  return std::all_of(cells_.begin(), cells_.end(), [](const Cell& cell) {
    bool plausible = true;
    for (int c = 0; c < 3; ++c) plausible = plausible && cell.sum[c] >= 0 && cell.sum_of_squares[c] >= 0;
    return plausible;
  });
}

std::vector<float> SampleGuide::needs() const {
  std::vector<float> raw(cells_.size()), smooth(cells_.size());
  parallel_for(cells_.size(), [&](size_t i) { raw[i] = squared_need(cells_[i]); });
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

size_t SamplePlan::planning_bytes_per_pixel() { return Film::halves * HalfPlan::bytes_per_pixel(); }

SamplePlan SamplePlan::uniform(const SamplesDrawn& drawn, uint32_t size) {
  Numbers plan;
  plan.size = size;
  // An odd sample goes to the half that has fewer.
  plan.odd_half = drawn.guiding[1] < drawn.guiding[0] ? 1 : 0;
  return SamplePlan(std::move(plan));
}

SamplePlan SamplePlan::adaptive(const SamplesDrawn& drawn, std::span<const SampleGuide, Film::halves> guides,
                                uint32_t size) {
  Numbers plan;
  plan.width = guides[0].width();
  plan.size = size;
  plan.guiding = uint32_t(size * guiding_part / 2);
  plan.counts.resize(drawn.extra.size());
  for (int half = 0; half < Film::halves; ++half)
    HalfPlan(drawn, half, guides[size_t(1 - half)], size).fill(plan.counts, half);
  return SamplePlan(std::move(plan));
}

}  // namespace vernier
