#include "core/image/error_estimate.h"

#include <limits>

#include "core/base/parallel.h"

namespace vernier {
namespace {

constexpr double epsilon = 0.01;           // of the relative error, as in its definition
constexpr int pool_radius = 7;             // pixels: 225 squared differences pin the gain to about a tenth
constexpr uint32_t fewest_samples = 8;     // fewer say too little about a pixel's tail
constexpr double heavy_share = 0.25;       // of a pixel's light in one sample
constexpr double dominating_share = 0.25;  // of its neighbourhood's squared differences in one pixel
constexpr double common_heavy = 0.2;       // of a neighbourhood's pixels with such a sample

double sum(const Vec3d& v) { return v.x + v.y + v.z; }

/// Square of half the difference of the halves: its expectation is the variance of their mean.
Vec3d squared_half_difference(const Film& film, int x, int y) {
  const Vec3d d = (film.half_mean(x, y, 0) - film.half_mean(x, y, 1)) / 2.0;
  return d * d;
}

Vec3d independent_variance(const Film& film, int x, int y) {
  return (film.half_mean_variance(x, y, 0) + film.half_mean_variance(x, y, 1)) / 4.0;
}

/// Sums over square windows of an image of doubles, through per-row passes.
class Windows {
 public:
  Windows(int width, int height) : width_(width), height_(height), values_(size_t(width) * height) {}
  double& at(int x, int y) { return values_[size_t(y) * width_ + x]; }
  double at(int x, int y) const { return values_[size_t(y) * width_ + x]; }

  /// Replaces each value by the sum over its window.
  void sum() {
    std::vector<double> rows(values_.size());
    parallel_for(size_t(height_), [&](size_t y) {
      for (int x = 0; x < width_; ++x) {
        double v = 0;
        for (int k = std::max(0, x - pool_radius); k <= std::min(width_ - 1, x + pool_radius); ++k)
          v += values_[y * width_ + k];
        rows[y * width_ + x] = v;
      }
    });
    parallel_for(size_t(height_), [&](size_t row) {
      const int y = int(row);
      for (int x = 0; x < width_; ++x) {
        double v = 0;
        for (int k = std::max(0, y - pool_radius); k <= std::min(height_ - 1, y + pool_radius); ++k)
          v += rows[size_t(k) * width_ + x];
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
        difference_.at(x, y) = sum(squared_half_difference(film, x, y));
        independent_.at(x, y) = sum(independent_variance(film, x, y));
      }
    });
    for (Windows* windows : {&difference_, &independent_, &heavy_, &pixels_}) windows->sum();
  }

  bool is_reliable(int x, int y) const {
    return !is_heavy(x, y) && heavy_.at(x, y) <= common_heavy * pixels_.at(x, y) &&
           sum(squared_half_difference(film_, x, y)) <= dominating_share * difference_.at(x, y);
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
  Windows difference_, independent_, heavy_, pixels_;
};

/// What the pixel's error may be relative to. A pixel that owes much of its light to one sample shows either
/// a fluke, and the truth is about the rest, or light that is seldom found, and the truth is nearer to what
/// it shows: the sample cannot tell. What both halves agree on, or a neighbour shows too, is no fluke.
struct PlausibleValues {
  Vec3d doubting, believing;
};

PlausibleValues plausible_values(const Film& film, int x, int y) {
  Vec3d confirmed = min(film.half_mean(x, y, 0), film.half_mean(x, y, 1));
  for (int j = std::max(0, y - 1); j <= std::min(film.height() - 1, y + 1); ++j)
    for (int i = std::max(0, x - 1); i <= std::min(film.width() - 1, x + 1); ++i)
      if (i != x || j != y) confirmed = max(confirmed, film.pixel(i, j));
  const Vec3d own = film.pixel(x, y);
  const Vec3d rest = own * (1 - film.largest_share(x, y));
  return {min(own, max(confirmed, rest)), min(own, max(max(confirmed, rest), own / 3.0))};
}

/// Sum of squared relative errors, and of their squares, over pixels.
struct RelativeSums {
  double sum = 0, squares = 0;

  void add(double relative) {
    sum += relative;
    squares += relative * relative;
  }
  void add(const RelativeSums& other) {
    sum += other.sum;
    squares += other.squares;
  }
  double mean(double n) const { return sum / n; }
  /// Half the width of a 95 % interval for the mean that the image has, around the estimated one: pixels are
  /// independent, and the image's own errors scatter as much as the differences of its halves.
  double margin(double n) const {
    const double variance = std::max(0.0, squares / n - square(sum / n)) / std::max(1.0, n - 1);
    return 1.96 * std::sqrt(2 * variance);
  }
};

/// Sums over one row of pixels.
struct RowSums {
  RelativeSums doubting, believing;
  size_t unreliable = 0;
  bool complete = true;

  void add(const RowSums& other) {
    doubting.add(other.doubting);
    believing.add(other.believing);
    unreliable += other.unreliable;
    complete = complete && other.complete;
  }
};

/// The mean over channels of the squares over value^2 + epsilon.
double relative(const Vec3d& squared, const Vec3d& value) {
  double total = 0;
  for (int c = 0; c < 3; ++c) total += squared[c] / (value[c] * value[c] + epsilon) / 3;
  return total;
}

RowSums row_sums(const Film& film, const Surroundings& surroundings, int y) {
  RowSums sums;
  for (int x = 0; x < film.width(); ++x) {
    const Vec3d squared = squared_half_difference(film, x, y);
    const PlausibleValues values = plausible_values(film, x, y);
    sums.doubting.add(relative(squared, values.doubting));
    sums.believing.add(relative(squared, values.believing));
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
  for (const RowSums& row : rows) total.add(row);
  const double n = double(film.width()) * film.height();
  ErrorEstimate estimate;
  estimate.unreliable = double(total.unreliable) / n;
  if (!total.complete) {
    estimate.rel_rmse = estimate.low = estimate.high = std::numeric_limits<double>::quiet_NaN();
    return estimate;
  }
  const double most = total.doubting.mean(n), least = total.believing.mean(n);
  estimate.rel_rmse = std::sqrt(std::sqrt(most * least));
  estimate.low = std::sqrt(std::max(0.0, least - total.believing.margin(n)));
  estimate.high = std::sqrt(most + total.doubting.margin(n));
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
