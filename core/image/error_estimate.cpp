#include "core/image/error_estimate.h"

#include <limits>

#include "core/base/parallel.h"

namespace vernier {
namespace {

constexpr double epsilon = 0.01;           // of the relative error, as in its definition
constexpr int pool_radius = 7;             // pixels: 225 squared differences pin the gain to about a tenth
constexpr uint32_t fewest_samples = 8;     // fewer say too little about a pixel's tail
constexpr double heavy_share = 0.25;       // of a pixel's light in one sample
constexpr double dominating_share = 0.25;  // of a neighbourhood's squared differences in one pixel
constexpr double common_heavy = 0.1;       // of a neighbourhood's pixels with such a sample

double sum(const Vec3d& v) { return v.x + v.y + v.z; }

/// Square of half the difference of the halves: its expectation is the variance of their mean.
Vec3d squared_half_difference(const Film& film, int x, int y) {
  const Vec3d d = (film.half_mean(x, y, 0) - film.half_mean(x, y, 1)) / 2.0;
  return d * d;
}

Vec3d independent_variance(const Film& film, int x, int y) {
  return (film.half_mean_variance(x, y, 0) + film.half_mean_variance(x, y, 1)) / 4.0;
}

/// Sums and maxima over square windows, through per-row passes: window sums of an image of doubles.
class Windows {
 public:
  Windows(int width, int height) : width_(width), height_(height), values_(size_t(width) * height) {}
  double& at(int x, int y) { return values_[size_t(y) * width_ + x]; }
  double at(int x, int y) const { return values_[size_t(y) * width_ + x]; }

  /// Replaces each value by combine() over its window.
  template <typename Combine>
  void pool(const Combine& combine) {
    std::vector<double> rows(values_.size());
    parallel_for(size_t(height_), [&](size_t y) {
      for (int x = 0; x < width_; ++x) {
        double v = 0;
        for (int k = std::max(0, x - pool_radius); k <= std::min(width_ - 1, x + pool_radius); ++k)
          v = combine(v, values_[y * width_ + k]);
        rows[y * width_ + x] = v;
      }
    });
    parallel_for(size_t(height_), [&](size_t row) {
      const int y = int(row);
      for (int x = 0; x < width_; ++x) {
        double v = 0;
        for (int k = std::max(0, y - pool_radius); k <= std::min(height_ - 1, y + pool_radius); ++k)
          v = combine(v, rows[size_t(k) * width_ + x]);
        values_[row * width_ + x] = v;
      }
    });
  }

 private:
  int width_, height_;
  std::vector<double> values_;
};

/// What the pixels around each pixel say. Pixels that owe their light to one sample are left out of the sums,
/// for one of them would drown the rest, and counted instead: their neighbours may owe light to a sample not
/// yet drawn.
class Surroundings {
 public:
  explicit Surroundings(const Film& film)
      : film_(film),
        difference_(film.width(), film.height()),
        independent_(film.width(), film.height()),
        largest_(film.width(), film.height()),
        heavy_(film.width(), film.height()),
        pixels_(film.width(), film.height()) {
    parallel_for(size_t(film.height()), [&](size_t row) {
      const int y = int(row);
      for (int x = 0; x < film.width(); ++x) {
        pixels_.at(x, y) = 1;
        if (is_heavy(x, y)) {
          heavy_.at(x, y) = 1;
          continue;
        }
        difference_.at(x, y) = largest_.at(x, y) = sum(squared_half_difference(film, x, y));
        independent_.at(x, y) = sum(independent_variance(film, x, y));
      }
    });
    const auto add = [](double a, double b) { return a + b; };
    for (Windows* windows : {&difference_, &independent_, &heavy_, &pixels_}) windows->pool(add);
    largest_.pool([](double a, double b) { return std::max(a, b); });
  }

  bool is_reliable(int x, int y) const {
    return !is_heavy(x, y) && heavy_.at(x, y) <= common_heavy * pixels_.at(x, y) &&
           largest_.at(x, y) <= dominating_share * difference_.at(x, y);
  }

  /// Variance of the pixel's mean: its own samples' spread, which they know well but which ignores
  /// stratification, scaled by what stratification gains around it, which the halves' differences know.
  Vec3d variance(int x, int y) const {
    const double pooled = independent_.at(x, y);
    return pooled > 0 ? independent_variance(film_, x, y) * (difference_.at(x, y) / pooled)
                      : squared_half_difference(film_, x, y);
  }

 private:
  bool is_heavy(int x, int y) const {
    return film_.samples(x, y) < fewest_samples || film_.largest_share(x, y) > heavy_share;
  }

  const Film& film_;
  Windows difference_, independent_, largest_, heavy_, pixels_;
};

/// The pixel's value as far as it is not a fluke of its own: no more than what both halves agree on or a
/// neighbour shows too. A bright outlier would otherwise be taken for the truth that its own error is
/// relative to.
Vec3d plausible_value(const Film& film, int x, int y) {
  Vec3d confirmed = min(film.half_mean(x, y, 0), film.half_mean(x, y, 1));
  for (int j = std::max(0, y - 1); j <= std::min(film.height() - 1, y + 1); ++j)
    for (int i = std::max(0, x - 1); i <= std::min(film.width() - 1, x + 1); ++i)
      if (i != x || j != y) confirmed = max(confirmed, film.pixel(i, j));
  const Vec3d own = film.pixel(x, y);
  return min(own, max(confirmed, own / 3.0));
}

/// Squared relative error of one pixel, the mean of its channels.
double relative_error(const Film& film, int x, int y) {
  const Vec3d squared = squared_half_difference(film, x, y);
  const Vec3d value = plausible_value(film, x, y);
  double relative = 0;
  for (int c = 0; c < 3; ++c) relative += squared[c] / (value[c] * value[c] + epsilon) / 3;
  return relative;
}

/// Sums over one row of pixels.
struct RowSums {
  double relative = 0, relative_squared = 0;
  size_t unreliable = 0;
  bool complete = true;
};

RowSums row_sums(const Film& film, const Surroundings& surroundings, int y) {
  RowSums sums;
  for (int x = 0; x < film.width(); ++x) {
    const double relative = relative_error(film, x, y);
    sums.relative += relative;
    sums.relative_squared += relative * relative;
    sums.unreliable += !surroundings.is_reliable(x, y);
    sums.complete = sums.complete && film.samples(x, y, 0) > 0 && film.samples(x, y, 1) > 0;
  }
  return sums;
}

}  // namespace

ErrorEstimate estimate_error(const Film& film) {
  const Surroundings surroundings(film);
  std::vector<RowSums> rows(size_t(film.height()));
  parallel_for(rows.size(), [&](size_t y) { rows[y] = row_sums(film, surroundings, int(y)); });
  RowSums total;
  for (const RowSums& row : rows) {
    total.relative += row.relative;
    total.relative_squared += row.relative_squared;
    total.unreliable += row.unreliable;
    total.complete = total.complete && row.complete;
  }
  const double n = double(film.width()) * film.height();
  ErrorEstimate estimate;
  estimate.unreliable = double(total.unreliable) / n;
  if (!total.complete) {
    estimate.rel_rmse = estimate.low = estimate.high = std::numeric_limits<double>::quiet_NaN();
    return estimate;
  }
  // Pixels are independent, so the mean over them has a standard error of its own.
  const double mean = total.relative / n;
  const double spread =
      n > 1 ? std::sqrt(std::max(0.0, total.relative_squared / n - mean * mean) / (n - 1)) : mean;
  estimate.rel_rmse = std::sqrt(mean);
  estimate.low = std::sqrt(std::max(0.0, mean - 1.96 * spread));
  estimate.high = std::sqrt(mean + 1.96 * spread);
  return estimate;
}

ErrorLayers error_layers(const Film& film) {
  ErrorLayers layers{Image(film.width(), film.height(), 3), Image(film.width(), film.height(), 1)};
  const Surroundings surroundings(film);
  parallel_for(size_t(film.height()), [&](size_t row) {
    const int y = int(row);
    for (int x = 0; x < film.width(); ++x) {
      const Vec3d variance = surroundings.variance(x, y);
      for (int c = 0; c < 3; ++c) layers.standard_error.pixel(x, y)[c] = float(std::sqrt(variance[c]));
      *layers.unreliable.pixel(x, y) = surroundings.is_reliable(x, y) ? 0.f : 1.f;
    }
  });
  return layers;
}

}  // namespace vernier
