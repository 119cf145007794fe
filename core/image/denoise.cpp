#include "core/image/denoise.h"

#include <cmath>

#include "core/base/error.h"
#include "core/image/convolve.h"
#include "core/image/denoise_filters.h"

namespace vernier {
namespace {

constexpr Denoiser table[] = {
    {"nlm", "non-local means: averages pixels whose surroundings look alike, given the noise", denoise_nlm},
    {"bilateral", "averages neighbours whose colours differ no more than their noise", denoise_bilateral},
    {"gaussian", "averages neighbours by distance, as far as the noise explains the change",
     denoise_gaussian},
    {"median", "median of the 5 x 5 pixels around, as far as the noise explains the change", denoise_median},
};

constexpr double epsilon = 0.01;  // of the relative error, as in core/image/error_estimate.h
constexpr int block = 32;         // pixels a side: wider than any filter's window
constexpr int pool = 15;          // pixels a side over which the noise that is left is averaged

double squared(double x) { return x * x; }

/// Sums of the squared relative errors of the pixels of a block.
struct BlockSums {
  double noisy = 0, denoised = 0, pixels = 0;
};

/// What a pixel's error is relative to, in place of the truth: its denoised value. Lights that the filter
/// took away would count as many times themselves, so where both halves saw far more it is what they agree
/// on, and in any case a third of what they saw on average.
double truth_like(double a, double b, double denoised) {
  constexpr double far = 4;
  const double confirmed = std::min(a, b);
  return confirmed > far * denoised ? confirmed : std::max(denoised, (a + b) / 6);
}

/// The squares of a channel's relative errors are its squared errors times this over 3.
double relative_weight(float a, float b, float fa, float fb) {
  return 1 / (squared(truth_like(a, b, 0.5 * (double(fa) + fb))) + epsilon);
}

/// What one pixel's halves a and b, filtered to fa and fb, say of its squared errors.
void add_pixel(BlockSums& sums, const float* a, const float* b, const float* fa, const float* fb) {
  ++sums.pixels;
  for (int c = 0; c < 3; ++c) {
    const double weight = relative_weight(a[c], b[c], fa[c], fb[c]) / 3;
    const double half_variance = squared(double(a[c]) - b[c]) / 2;
    // Each filtered half against the other half, which knows nothing of it: its own squared error and the
    // other's variance.
    const double half_error =
        (squared(double(fa[c]) - b[c]) + squared(double(fb[c]) - a[c])) / 2 - half_variance;
    // The mean of the filtered halves has all of their bias and half of their variance.
    sums.denoised += weight * (half_error - squared(double(fa[c]) - fb[c]) / 4);
    sums.noisy += weight * half_variance / 2;
  }
}

std::vector<BlockSums> block_sums(const Image& a, const Image& b, const Image& fa, const Image& fb) {
  const int columns = (a.width + block - 1) / block, rows = (a.height + block - 1) / block;
  std::vector<BlockSums> sums(size_t(columns) * size_t(rows));
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      // A pixel that is not finite has no error to speak of.
      if (const float sum = max_component(rgb_at(a, x, y) + rgb_at(b, x, y)); std::isfinite(sum))
        add_pixel(sums[size_t(y / block) * size_t(columns) + size_t(x / block)], a.pixel(x, y), b.pixel(x, y),
                  fa.pixel(x, y), fb.pixel(x, y));
  return sums;
}

/// Errors of neighbouring pixels go together after filtering, so the interval is that of the blocks.
DenoisedError estimate(const std::vector<BlockSums>& blocks) {
  BlockSums total;
  for (const BlockSums& sums : blocks) {
    total.noisy += sums.noisy;
    total.denoised += sums.denoised;
    total.pixels += sums.pixels;
  }
  const double mean = total.denoised / total.pixels;
  double spread = 0;
  for (const BlockSums& sums : blocks) spread += squared(sums.denoised - mean * sums.pixels);
  const double n = double(blocks.size());
  const double error = n > 1 ? std::sqrt(spread * n / (n - 1)) / total.pixels : std::abs(mean);
  const auto root = [](double x) { return std::sqrt(std::max(0.0, x)); };
  return {root(total.noisy / total.pixels), root(mean), root(mean - 1.96 * error), root(mean + 1.96 * error)};
}

/// The variance that is left, (fa - fb)^2 / 4, averaged about each pixel as a part of what the error is
/// relative to, lest a lamp's is its dark surroundings', times one factor for the whole picture: its squared
/// error over that variance, which lacks what the filter has blurred.
Image pixel_errors(const Image& a, const Image& b, const Image& fa, const Image& fb, double rel_rmse) {
  const auto weight = [&](size_t i) {
    const double w = relative_weight(a.values[i], b.values[i], fa.values[i], fb.values[i]);
    return std::isfinite(w) ? w : 1 / epsilon;
  };
  Image left(a.width, a.height, 3);
  double sum = 0;
  for (size_t i = 0; i < left.values.size(); ++i) {
    const double relative = weight(i) * squared(double(fa.values[i]) - fb.values[i]) / 4;
    left.values[i] = float(relative);
    sum += relative;
  }
  const double factor = sum > 0 ? std::max(1.0, squared(rel_rmse) * double(left.values.size()) / sum) : 1;
  const std::vector<float> mean(pool, 1.f / pool);
  left = convolve(left, mean, mean);
  for (size_t i = 0; i < left.values.size(); ++i)
    left.values[i] = float(std::sqrt(factor * left.values[i] / weight(i)));
  return left;
}

}  // namespace

std::span<const Denoiser> denoisers() { return table; }

DenoisedHalves denoise_halves(const Denoiser& denoiser, const NoisyImage& first, const NoisyImage& second) {
  const Image &a = first.color, &b = second.color;
  if (a.width != b.width || a.height != b.height)
    throw Error(ErrorKind::usage, "the two halves of a picture to denoise differ in size");
  const Image fa = denoiser.filter(first), fb = denoiser.filter(second);
  DenoisedHalves result;
  result.picture = fa;
  for (size_t i = 0; i < fa.values.size(); ++i)
    result.picture.values[i] = 0.5f * (fa.values[i] + fb.values[i]);
  result.error = estimate(block_sums(a, b, fa, fb));
  result.pixel_error = pixel_errors(a, b, fa, fb, result.error.rel_rmse);
  return result;
}

}  // namespace vernier
