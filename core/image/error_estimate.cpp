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

/// Half-difference sums, independent-sample variances, and the largest half difference, pooled around each
/// pixel.
struct Pooled {
  Windows difference, independent, largest;
  Pooled(const Film& film)
      : difference(film.width(), film.height()),
        independent(film.width(), film.height()),
        largest(film.width(), film.height()) {
    for (int y = 0; y < film.height(); ++y)
      for (int x = 0; x < film.width(); ++x) {
        difference.at(x, y) = largest.at(x, y) = sum(squared_half_difference(film, x, y));
        independent.at(x, y) = sum(independent_variance(film, x, y));
      }
    const auto add = [](double a, double b) { return a + b; };
    difference.pool(add);
    independent.pool(add);
    largest.pool([](double a, double b) { return std::max(a, b); });
  }

  bool is_reliable(const Film& film, int x, int y) {
    return film.samples(x, y) >= fewest_samples && film.largest_share(x, y) <= heavy_share &&
           largest.at(x, y) <= dominating_share * difference.at(x, y);
  }
};

}  // namespace

ErrorEstimate estimate_error(const Film& film) {
  double total = 0, total_squared = 0;
  size_t flagged = 0;
  bool complete = true;
  Pooled pooled(film);
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      complete = complete && film.samples(x, y, 0) > 0 && film.samples(x, y, 1) > 0;
      const Vec3d squared = squared_half_difference(film, x, y);
      const Vec3d value = film.pixel(x, y);
      double relative = 0;
      for (int c = 0; c < 3; ++c) relative += squared[c] / (value[c] * value[c] + epsilon) / 3;
      total += relative;
      total_squared += relative * relative;
      flagged += !pooled.is_reliable(film, x, y);
    }
  const double n = double(film.width()) * film.height();
  ErrorEstimate estimate;
  estimate.unreliable = double(flagged) / n;
  if (!complete) {
    estimate.rel_rmse = estimate.low = estimate.high = std::numeric_limits<double>::quiet_NaN();
    return estimate;
  }
  // Pixels are independent, so the mean over them has a standard error of its own.
  const double mean = total / n;
  const double spread = n > 1 ? std::sqrt(std::max(0.0, total_squared / n - mean * mean) / (n - 1)) : mean;
  estimate.rel_rmse = std::sqrt(mean);
  estimate.low = std::sqrt(std::max(0.0, mean - 1.96 * spread));
  estimate.high = std::sqrt(mean + 1.96 * spread);
  return estimate;
}

ErrorLayers error_layers(const Film& film) {
  ErrorLayers layers{Image(film.width(), film.height(), 3), Image(film.width(), film.height(), 1)};
  Pooled pooled(film);
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      // The pixel's own spread, which many samples know well but which ignores stratification, scaled by what
      // stratification gains around it, which the halves' differences know.
      const double pooled_independent = pooled.independent.at(x, y);
      const double gain = pooled_independent > 0 ? pooled.difference.at(x, y) / pooled_independent : 0;
      const Vec3d own = pooled_independent > 0 ? independent_variance(film, x, y) * gain
                                               : squared_half_difference(film, x, y);
      for (int c = 0; c < 3; ++c) layers.standard_error.pixel(x, y)[c] = float(std::sqrt(own[c]));
      *layers.unreliable.pixel(x, y) = pooled.is_reliable(film, x, y) ? 0.f : 1.f;
    }
  return layers;
}

}  // namespace vernier
