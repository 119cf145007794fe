#include "integrators/sample_plan.h"

#include "core/base/parallel.h"

namespace vernier {
namespace {

/// How strongly the image's relative error depends on more samples of a pixel, as seen by one half: the
/// spread of a single sample over sqrt(r^2 + 0.01).
double need(const Film& film, int x, int y, int half) {
  const Vec3d mean = film.half_mean(x, y, half);
  const Vec3d variance = film.half_mean_variance(x, y, half) * double(film.samples(x, y, half));
  double relative = 0;
  for (int c = 0; c < 3; ++c) relative += variance[c] / (mean[c] * mean[c] + 0.01);
  return std::sqrt(relative);
}

/// Needs of one half, each the mean over its 3x3 neighbourhood: one pixel's own figure is too noisy to act
/// on, and a neighbour's surprise is a warning.
std::vector<double> smooth_needs(const Film& film, int half) {
  const int w = film.width(), h = film.height();
  std::vector<double> raw(size_t(w) * h), smooth(raw.size());
  parallel_for(size_t(h), [&](size_t y) {
    for (int x = 0; x < w; ++x) raw[y * w + x] = need(film, x, int(y), half);
  });
  parallel_for(size_t(h), [&](size_t row) {
    const int y = int(row);
    for (int x = 0; x < w; ++x) {
      double sum = 0;
      int count = 0;
      for (int j = std::max(0, y - 1); j <= std::min(h - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(w - 1, x + 1); ++i, ++count)
          sum += raw[size_t(j) * w + i];
      smooth[row * w + x] = sum / count;
    }
  });
  return smooth;
}

}  // namespace

SamplePlan SamplePlan::uniform(const Film& film, uint32_t count) {
  SamplePlan plan;
  plan.width_ = film.width();
  // An odd sample goes to the half that has fewer.
  const bool second_lags = film.samples(0, 0, 1) < film.samples(0, 0, 0);
  plan.uniform_[0] = count / 2 + (count % 2 && !second_lags);
  plan.uniform_[1] = count - plan.uniform_[0];
  return plan;
}

SamplePlan SamplePlan::adaptive(const Film& film, uint32_t count) {
  SamplePlan plan;
  plan.width_ = film.width();
  const size_t pixels = size_t(film.width()) * film.height();
  plan.counts_.resize(pixels * Film::halves);
  const double per_half = count / 2.0;
  // A pixel gets at least a quarter of its even share, so that none is given up on luck, and at most eight
  // times.
  const double fewest = per_half / 4, most = per_half * 8;
  for (int half = 0; half < Film::halves; ++half) {
    const std::vector<double> needs = smooth_needs(film, 1 - half);
    double need_sum = 0, done_sum = 0;
    for (size_t i = 0; i < pixels; ++i) {
      need_sum += needs[i];
      done_sum += film.samples(int(i % film.width()), int(i / film.width()), half);
    }
    if (!(need_sum > 0)) return uniform(film, count);
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
      carried += wanted(i);
      const double whole = std::floor(carried);
      carried -= whole;
      plan.counts_[i * Film::halves + size_t(half)] = uint16_t(std::min(whole, 65535.0));
    }
  }
  return plan;
}

}  // namespace vernier
