#include "integrators/sample_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"

namespace vernier {
namespace {

/// Samples of one half in a pass of `size` samples a pixel, by the other half's guide.
class HalfPlan {
 public:
  HalfPlan(const Film& film, int which, const SampleGuide& guide, uint32_t size)
      : needs_(guide.needs()),
        done_(needs_.size()),
        fewest_(std::floor(size / 8.0)),
        // At most eight times the even share, so that a plan made on little evidence does not spend
        // everything.
        most_(std::min(size * 4.0, 65535.0)) {
    for (size_t i = 0; i < done_.size(); ++i) {
      done_[i] = film.samples(int(i % film.width()), int(i / film.width()), which);
      done_sum_ += done_[i];
      need_sum_ += needs_[i];
    }
  }

  static constexpr size_t bytes_per_pixel() {
    return sizeof(decltype(needs_)::value_type) + sizeof(decltype(done_)::value_type);
  }
  bool is_even() const { return !(need_sum_ > 0); }
  /// What every pixel gets at least.
  double fewest() const { return fewest_; }

  /// Of a pass that every pixel in need could use as far as it may: where few are, the rest of a larger one
  /// would have no place.
  uint32_t largest_size() const {
    double samples = 0;
    for (const float need : needs_) samples += need > 0 ? most_ : fewest_;
    return uint32_t(std::min(2 * samples / double(needs_.size()), 1e9));
  }

  /// Sets this half's counts, on average half of `size`.
  void fill(std::vector<uint16_t>& counts, int which, uint32_t size) const {
    const double factor = find_factor(size / 2.0 * double(needs_.size()));
    // Fractions are carried along the row of pixels so that the total is met.
    double carried = 0;
    for (size_t i = 0; i < needs_.size(); ++i) {
      carried += wanted(i, factor) - fewest_;
      const double whole = std::floor(carried);
      carried -= whole;
      counts[i * Film::halves + size_t(which)] = uint16_t(std::min(fewest_ + whole, 65535.0));
    }
  }

 private:
  /// The best total of a pixel is in proportion to its need (Neyman allocation). Where that has been passed
  /// already, or the bounds bite, the samples go elsewhere, by way of the factor.
  double wanted(size_t i, double factor) const {
    return std::clamp(factor * needs_[i] - done_[i], fewest_, most_);
  }

  /// The factor that spends `budget`, to a thousandth. Steps in proportion find it in a few rounds, unless
  /// the need is that of few pixels; then it is bracketed and halved.
  double find_factor(double budget) const {
    double factor = (done_sum_ + budget) / need_sum_, below = 0, above = 0;
    for (int round = 0; round < 200; ++round) {
      double spent = 0;
      for (size_t i = 0; i < needs_.size(); ++i) spent += wanted(i, factor);
      if (std::abs(spent - budget) < 0.001 * budget) break;
      (spent < budget ? below : above) = factor;
      if (round < 20)
        factor *= std::clamp(1 + (budget - spent) / (done_sum_ + budget), 0.5, 2.0);
      else
        factor = above > 0 ? (below + above) / 2 : 2 * factor;
    }
    return factor;
  }

  std::vector<float> needs_;
  std::vector<double> done_;  ///< samples that the half has
  double fewest_, most_;
  double done_sum_ = 0, need_sum_ = 0;
};

}  // namespace

float SampleGuide::squared_need(const Cell& cell) {
  if (cell.count < 2) return 0;
  const auto n = float(cell.count);
  float relative = 0;
  for (int c = 0; c < 3; ++c) {
    const float mean = cell.sum[c] / n;
    const float variance = std::max(0.f, cell.sum_of_squares[c] - cell.sum[c] * mean) / (n - 1);
    relative += variance / (mean * mean + 0.01f);
  }
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

SamplePlan SamplePlan::uniform(const Film& film, uint32_t size) {
  Numbers plan;
  plan.width = film.width();
  plan.size = size;
  // An odd sample goes to the half that has fewer.
  plan.odd_half = film.samples(0, 0, 1) < film.samples(0, 0, 0) ? 1 : 0;
  return SamplePlan(std::move(plan));
}

SamplePlan SamplePlan::adaptive(const Film& film, std::span<const SampleGuide, Film::halves> guides,
                                uint32_t size) {
  const std::array<HalfPlan, Film::halves> halves{HalfPlan(film, 0, guides[1], size),
                                                  HalfPlan(film, 1, guides[0], size)};
  if (halves[0].is_even() || halves[1].is_even()) return uniform(film, size);
  Numbers plan;
  plan.width = film.width();
  plan.fewest = uint32_t(halves[0].fewest());
  plan.size = std::min({size, halves[0].largest_size(), halves[1].largest_size()});
  plan.counts.resize(size_t(film.width()) * film.height() * Film::halves);
  for (int half = 0; half < Film::halves; ++half) halves[size_t(half)].fill(plan.counts, half, plan.size);
  return SamplePlan(std::move(plan));
}

}  // namespace vernier
