// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "core/base/parallel.h"
#include "core/denoise/denoise_filters.h"

// Weighted averages over a window: bilateral, Gaussian and non-local means differ in their weights. All
// weights of one offset between two pixels are computed for a band of rows at a time, in loops over columns
// that vectorise.

namespace vernier {
namespace {

constexpr int band_rows = 32;
/// A pixel whose variance is more than this many times that of the pixel it would be averaged into counts for
/// no noisier: any colour would be within its noise, and a bright one would spread into its sure
/// surroundings.
constexpr float noisier = 16;

/// Close to exp(-distance), falling smoothly to zero at 16, and cheap.
inline float kernel(float distance) {
  float t = std::max(0.f, 1 - distance / 16);
  for (int i = 0; i < 4; ++i) t *= t;
  return t;
}

/// Channels apart, so that loops over columns have unit stride.
struct Planes {
  int width, height, channels;
  std::vector<float> values;

  explicit Planes(const Image& image) : width(image.width), height(image.height), channels(image.channels) {
    values.resize(image.values.size());
    for (int c = 0; c < channels; ++c)
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) values[index(c, y) + size_t(x)] = image.pixel(x, y)[c];
  }
  const float* row(int c, int y) const { return &values[index(c, y)]; }

 private:
  size_t index(int c, int y) const { return (size_t(c) * size_t(height) + size_t(y)) * size_t(width); }
};

/// The columns of p for which p and q = p + offset both lie inside.
struct Columns {
  int begin, end;
  Columns(int width, int dx) : begin(std::max(0, -dx)), end(std::min(width, width - dx)) {}
};

class BandFilter {
 public:
  BandFilter(const Planes& color, const Planes& variance, const Planes& features, const Weights& weights,
             int top)
      : color_(color),
        variance_(variance),
        features_(features),
        weights_(weights),
        top_(top),
        bottom_(std::min(color.height, top + band_rows)),
        width_(size_t(color.width)) {
    const size_t pixels = width_ * size_t(bottom_ - top_);
    weight_sum_.resize(pixels);
    for (auto& sum : difference_sum_) sum.resize(pixels);
    distance_.resize(width_);
    weight_.resize(width_);
    const int patch_rows = bottom_ - top_ + 2 * weights.patch_radius;
    patch_.resize(width_ * size_t(patch_rows));
  }

  /// Writes the band's rows of `out`.
  void run(Image& out) {
    for (int dy = -weights_.radius; dy <= weights_.radius; ++dy)
      for (int dx = -weights_.radius; dx <= weights_.radius; ++dx) add_offset(dx, dy);
    for (int y = top_; y < bottom_; ++y)
      for (size_t x = 0; x < width_; ++x)
        for (int c = 0; c < 3; ++c) {
          const size_t at = width_ * size_t(y - top_) + x;
          const float value = color_.row(c, y)[x];
          // As a mean of differences, so that a constant picture stays as it is to the bit.
          const float mean = value + difference_sum_[size_t(c)][at] / weight_sum_[at];
          out.pixel(int(x), y)[c] = std::isfinite(mean) ? mean : value;
        }
  }

 private:
  bool inside(int y) const { return y >= 0 && y < color_.height; }

  void add_offset(int dx, int dy) {
    const Columns columns(color_.width, dx);
    if (columns.begin >= columns.end) return;
    const bool by_color = weights_.color_distance > 0;
    if (by_color) fill_patch_rows(dx, dy, columns);
    const float d2 = weights_.deviation > 0
                         ? 0.5f * float(dx * dx + dy * dy) / (weights_.deviation * weights_.deviation)
                         : 0.f;
    const float spatial = std::exp(-d2);
    for (int y = top_; y < bottom_; ++y) {
      if (!inside(y + dy)) continue;
      std::fill(distance_.begin(), distance_.end(), 0.f);
      if (by_color) add_patch_distance(y, dy, columns);
      add_feature_distance(y, dx, dy, columns);
      for (int x = columns.begin; x < columns.end; ++x)
        weight_[size_t(x)] = spatial * kernel(distance_[size_t(x)]);
      accumulate(y, dx, dy, columns);
    }
  }

  /// Squared difference of the colours of p and q beyond what noise explains, in units of k standard errors,
  /// mean of three channels (Rousselle, Knaus, Zwicker 2012, "Adaptive Rendering with Non-Local Means
  /// Filtering", equation 4).
  void color_distance_row(int y, int dx, int dy, const Columns& columns, float* out) const {
    const float k2 = weights_.color_distance * weights_.color_distance;
    constexpr float tiny = 1e-20f;
    for (int c = 0; c < 3; ++c) {
      const float* p = color_.row(c, y);
      const float* q = color_.row(c, y + dy) + dx;
      const float* vp = variance_.row(c, y);
      const float* vq = variance_.row(c, y + dy) + dx;
      for (int x = columns.begin; x < columns.end; ++x) {
        const float difference = p[x] - q[x];
        const float noise = vp[x] + std::min(vp[x], vq[x]);
        const float width = vp[x] + std::min(noisier * vp[x], vq[x]);
        const float d = (difference * difference - noise) / (tiny + k2 * width);
        out[x] += std::min(d, 1e4f) / 3;
      }
    }
  }

  /// Pixel distances of the rows that the band's patches reach, each already averaged along its row.
  void fill_patch_rows(int dx, int dy, const Columns& columns) {
    const int f = weights_.patch_radius;
    std::fill(patch_.begin(), patch_.end(), 0.f);
    for (int y = top_ - f; y < bottom_ + f; ++y) {
      if (!inside(y) || !inside(y + dy)) continue;
      float* row = &patch_[width_ * size_t(y - top_ + f)];
      if (f == 0) {
        color_distance_row(y, dx, dy, columns, row);
        continue;
      }
      std::fill(distance_.begin(), distance_.end(), 0.f);
      color_distance_row(y, dx, dy, columns, distance_.data());
      for (int x = columns.begin; x < columns.end; ++x) {
        const int from = std::max(columns.begin, x - f), to = std::min(columns.end, x + f + 1);
        float sum = 0;
        for (int i = from; i < to; ++i) sum += distance_[size_t(i)];
        row[x] = sum / float(to - from);
      }
    }
  }

  void add_patch_distance(int y, int dy, const Columns& columns) {
    const int f = weights_.patch_radius;
    int rows = 0;
    for (int j = y - f; j <= y + f; ++j) {
      if (!inside(j) || !inside(j + dy)) continue;
      const float* row = &patch_[width_ * size_t(j - top_ + f)];
      for (int x = columns.begin; x < columns.end; ++x) distance_[size_t(x)] += row[x];
      ++rows;
    }
    for (int x = columns.begin; x < columns.end; ++x)
      distance_[size_t(x)] = std::max(0.f, distance_[size_t(x)] / float(rows));
  }

  void add_feature_distance(int y, int dx, int dy, const Columns& columns) {
    for (int c = 0; c < features_.channels; ++c) {
      const float* p = features_.row(c, y);
      const float* q = features_.row(c, y + dy) + dx;
      for (int x = columns.begin; x < columns.end; ++x) distance_[size_t(x)] += square(p[x] - q[x]);
    }
  }

  void accumulate(int y, int dx, int dy, const Columns& columns) {
    const size_t row = width_ * size_t(y - top_);
    for (int x = columns.begin; x < columns.end; ++x) weight_sum_[row + size_t(x)] += weight_[size_t(x)];
    for (int c = 0; c < 3; ++c) {
      const float* p = color_.row(c, y);
      const float* q = color_.row(c, y + dy) + dx;
      float* sum = &difference_sum_[size_t(c)][row];
      for (int x = columns.begin; x < columns.end; ++x) sum[x] += weight_[size_t(x)] * (q[x] - p[x]);
    }
  }

  const Planes &color_, &variance_, &features_;
  const Weights weights_;
  const int top_, bottom_;
  const size_t width_;
  std::vector<float> weight_sum_, distance_, weight_, patch_;
  std::array<std::vector<float>, 3> difference_sum_;
};

}  // namespace

Image weighted_average(const GuidedImage& guided, const Weights& weights) {
  const Planes color(guided.color), variance(guided.variance), features(guided.features);
  Image result(color.width, color.height, 3);
  const size_t bands = (size_t(color.height) + band_rows - 1) / band_rows;
  parallel_for(bands, [&](size_t band) {
    BandFilter(color, variance, features, weights, int(band) * band_rows).run(result);
  });
  return result;
}

}  // namespace vernier
