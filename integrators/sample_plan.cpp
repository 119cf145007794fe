#include "integrators/sample_plan.h"

#include "core/base/parallel.h"

namespace vernier {

float SampleGuide::squared_need(const Cell& cell) {
  if (cell.count < 2) return 0;
  const auto n = float(cell.count);
  float relative = 0;
  for (int c = 0; c < 3; ++c) {
    const float mean = cell.sum[c] / n;
    const float variance = std::max(0.f, cell.sum_of_squares[c] - cell.sum[c] * mean) / (n - 1);
    relative += variance / (mean * mean + 0.01f);
  }
  return relative;
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
  Numbers plan;
  plan.width = film.width();
  plan.size = size;
  const size_t pixels = size_t(film.width()) * film.height();
  plan.counts.resize(pixels * Film::halves);
  const double per_half = size / 2.0;
  // At most eight times the even share, so that a plan made on little evidence does not spend everything.
  const double fewest = std::floor(per_half / 4), most = per_half * 8;
  plan.fewest = uint32_t(fewest);
  for (int half = 0; half < Film::halves; ++half) {
    const std::vector<float> needs = guides[size_t(1 - half)].needs();
    double need_sum = 0, done_sum = 0;
    for (size_t i = 0; i < pixels; ++i) {
      need_sum += needs[i];
      done_sum += film.samples(int(i % film.width()), int(i / film.width()), half);
    }
    if (!(need_sum > 0)) return uniform(film, size);
    const double budget = per_half * double(pixels);
    // The best total of a pixel is in proportion to its need (Neyman allocation). Where that has been passed
    // already, or the bounds bite, the budget goes elsewhere: a few rounds find the factor that spends it.
    double factor = (done_sum + budget) / need_sum;
    const auto wanted = [&](size_t i) {
      const double done = film.samples(int(i % film.width()), int(i / film.width()), half);
      return std::clamp(factor * needs[i] - done, fewest, most);
    };
    for (int round = 0; round < 20; ++round) {
      double spent = 0;
      for (size_t i = 0; i < pixels; ++i) spent += wanted(i);
      if (std::abs(spent - budget) < 0.001 * budget) break;
      factor *= std::clamp(1 + (budget - spent) / (done_sum + budget), 0.5, 2.0);
    }
    // Fractions are carried along the row of pixels so that the total is met.
    double carried = 0;
    for (size_t i = 0; i < pixels; ++i) {
      carried += wanted(i) - fewest;
      const double whole = std::floor(carried);
      carried -= whole;
      plan.counts[i * Film::halves + size_t(half)] = uint16_t(std::min(fewest + whole, 65535.0));
    }
  }
  return SamplePlan(std::move(plan));
}

}  // namespace vernier
