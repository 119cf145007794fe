// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"
#include "core/compare/metrics.h"
#include "core/film/error_estimate.h"
#include "core/film/pixel_reliability.h"

namespace vernier {
namespace {

constexpr int radius = 7;  // pixels: at best 225 squared differences, which say their mean to a tenth
constexpr float own_weight = 0.7f;                // at most, of a pixel's own variance
constexpr float floor_variance = 1e-8f;           // relative; keeps logarithms finite
const float similar_brightness = std::log(1.5f);  // pixels alike differ by less: in brightness
const float similar_variance = std::log(16.f);    // and in modelled variance,
const float max_log_excess = std::log(30.f);      // and show no variance beyond the model by more

/// One channel of one pixel, in units of the square of its brightness, r^2 + epsilon.
struct ChannelStatistics {
  float log_brightness = 0;
  float log_variance = 0;             ///< of its mean, were its samples independent
  float log_half[Film::halves] = {};  ///< the same as each half says
  float difference = 0;               ///< squared half difference
  float log_model = 0;                ///< log_variance, drawn towards that of the pixels alike
  float model = 0;                    ///< its exponential
};

/// One channel of an image.
class ChannelErrorModel {
 public:
  ChannelErrorModel(const Film& film, const Image& shrunk, int channel)
      : width_(film.width()), height_(film.height()), statistics_(size_t(width_) * height_) {
    for_each_pixel(
        [&](int x, int y) { at(x, y) = measure(film, shrunk.pixel(x, y)[channel], x, y, channel); });
    for_each_pixel([&](int x, int y) {
      ChannelStatistics& statistics = at(x, y);
      statistics.log_model = log_model(x, y);
      statistics.model = std::exp(statistics.log_model);
    });
  }

  static constexpr size_t bytes_per_pixel() { return sizeof(ChannelStatistics); }

  /// Variance of the pixel's value. The model knows only spreads of samples: what stratification gains, the
  /// differences of the halves say, over the pixels alike in brightness and variance. (An edge of a lamp is
  /// bright, varied and gains much, the wall beside it is none of these.) A firefly's difference says nothing
  /// of pixels that have none. Few squares know their mean badly, and intervals then have to be wider, as
  /// Student's are: by the relative variance of the squares' sum.
  double variance(int x, int y) const {
    const ChannelStatistics& own = at(x, y);
    const float most = own.log_model + max_log_excess;
    double differences = 0, squares = 0, models = 0;
    for_each_similar(x, y, [&](const ChannelStatistics& other) {
      if (!(std::abs(other.log_model - own.log_model) < similar_variance)) return;
      if (other.log_variance > most && own.log_variance <= most) return;
      differences += other.difference;
      squares += square(double(other.difference));
      models += double(other.model);
    });
    if (!(differences > 0)) return 0;
    const double widening = 1 + squares / square(differences);
    return std::exp(2 * double(own.log_brightness) + own.log_model) * differences / models * widening;
  }

 private:
  static ChannelStatistics measure(const Film& film, double shrunk, int x, int y, int channel) {
    const double brightness = shrunk * shrunk + relative_error_epsilon;
    ChannelStatistics statistics;
    double mean = 0;
    for (int half = 0; half < Film::halves; ++half) {
      const double variance = film.half_mean_variance(x, y, half)[channel] / 2 / brightness;
      statistics.log_half[half] = std::log(float(variance) + floor_variance);
      mean += variance / Film::halves;
    }
    statistics.log_brightness = float(std::log(brightness) / 2);
    statistics.log_variance = std::log(float(mean) + floor_variance);
    statistics.difference = float(squared_half_difference(film, x, y)[channel] / brightness);
    return statistics;
  }

  /// A few samples know a variance badly, the worse the heavier their tails, and a pixel that has missed the
  /// tail does not know that it has. So it is drawn towards the mean of the pixels alike in brightness, by
  /// how much of the variances' variation the halves have in common: the rest is noise (empirical Bayes, on
  /// logarithms; Smyth 2004, "Linear Models and Empirical Bayes Methods").
  float log_model(int x, int y) const {
    float sum = 0, squares = 0, half_sum[Film::halves] = {}, product = 0;
    int count = 0;
    const float own = at(x, y).log_variance;
    for_each_similar(x, y, [&](const ChannelStatistics& other) {
      const float apart = other.log_variance - own;
      const float first = other.log_half[0] - own, second = other.log_half[1] - own;
      sum += apart;
      squares += apart * apart;
      half_sum[0] += first;
      half_sum[1] += second;
      product += first * second;
      ++count;
    });
    const auto n = float(count);
    const float mean = sum / n, variance = squares / n - mean * mean;
    const float common = product / n - half_sum[0] / n * (half_sum[1] / n);
    const float weight = variance > 0 ? std::clamp(common / variance, 0.f, own_weight) : 0;
    return own + mean * (1 - weight);
  }

  template <typename Visit>
  void for_each_similar(int x, int y, const Visit& visit) const {
    const float own = at(x, y).log_brightness;
    for (int j = std::max(0, y - radius); j <= std::min(height_ - 1, y + radius); ++j)
      for (int i = std::max(0, x - radius); i <= std::min(width_ - 1, x + radius); ++i)
        if (std::abs(at(i, j).log_brightness - own) < similar_brightness) visit(at(i, j));
  }

  template <typename Body>
  void for_each_pixel(const Body& body) const {
    parallel_for(size_t(height_), [&](size_t row) {
      for (int x = 0; x < width_; ++x) body(x, int(row));
    });
  }

  ChannelStatistics& at(int x, int y) { return statistics_[size_t(y) * width_ + x]; }
  const ChannelStatistics& at(int x, int y) const { return statistics_[size_t(y) * width_ + x]; }

  int width_, height_;
  std::vector<ChannelStatistics> statistics_;
};

}  // namespace

size_t error_layers_bytes_per_pixel() {
  const size_t reliability = 4 * sizeof(float), result = 3 * sizeof(float);
  return std::max(assess_pixels_bytes_per_pixel(),
                  reliability + result + ChannelErrorModel::bytes_per_pixel());
}

ErrorLayers error_layers(const Film& film) {
  PixelReliability reliability = assess_pixels(film);
  ErrorLayers layers{Image(film.width(), film.height(), 3), std::move(reliability.unreliable)};
  for (int c = 0; c < 3; ++c) {
    const ChannelErrorModel channel(film, reliability.shrunk_mean, c);
    parallel_for(size_t(film.height()), [&](size_t y) {
      for (int x = 0; x < film.width(); ++x)
        layers.standard_error.pixel(x, int(y))[c] = float(std::sqrt(channel.variance(x, int(y))));
    });
  }
  return layers;
}

}  // namespace vernier
