#include "core/image/denoise.h"

#include <array>

#include "core/base/error.h"
#include "core/image/denoise_filters.h"

namespace vernier {
namespace {

constexpr Denoiser table[] = {
    {"nlm", "non-local means: averages pixels whose surroundings look alike, given the noise", denoise_nlm},
    {"bilateral", "averages neighbours whose colours differ no more than their noise", denoise_bilateral},
    {"gaussian", "averages neighbours by distance alone", denoise_gaussian},
    {"median", "median of 5 x 5 pixels: removes single bright ones, and their light", denoise_median},
#ifdef VERNIER_OIDN
    {"oidn", "Intel Open Image Denoise: a neural network", denoise_oidn},
#endif
};

double squared(double x) { return x * x; }

// Mean of numbers and its standard error.
struct Mean {
  double sum = 0, squares = 0, count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double value() const { return sum / count; }
  double error() const {
    return std::sqrt(std::max(0.0, squares / count - squared(value())) / std::max(1.0, count - 1));
  }
};

// Median of the halves' mean over the 3 x 3 about each pixel: what errors are relative to. A pixel's own
// noise hardly moves it; were it to, pixels that came out dark would weigh more for it.
Image typical_values(const Image& a, const Image& b) {
  Image mean = a;
  for (size_t i = 0; i < a.values.size(); ++i) mean.values[i] = 0.5f * (a.values[i] + b.values[i]);
  Image typical = mean;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      for (int c = 0; c < 3; ++c) {
        std::array<float, 9> window{};
        size_t count = 0;
        for (int j = std::max(0, y - 1); j <= std::min(a.height - 1, y + 1); ++j)
          for (int i = std::max(0, x - 1); i <= std::min(a.width - 1, x + 1); ++i)
            if (std::isfinite(mean.pixel(i, j)[c])) window[count++] = mean.pixel(i, j)[c];
        std::nth_element(window.begin(), window.begin() + count / 2, window.begin() + count);
        typical.pixel(x, y)[c] = window[count / 2];
      }
  return typical;
}

}  // namespace

std::span<const Denoiser> denoisers() { return table; }

DenoisedHalves denoise_halves(const Denoiser& denoiser, const NoisyImage& first, const NoisyImage& second) {
  if (first.color.width != second.color.width || first.color.height != second.color.height)
    throw Error(ErrorKind::usage, "the two halves of a picture to denoise differ in size");
  const Image &a = first.color, &b = second.color;
  const Image filtered_a = denoiser.filter(first), filtered_b = denoiser.filter(second);
  DenoisedHalves result;
  result.picture = filtered_a;
  for (size_t i = 0; i < filtered_a.values.size(); ++i)
    result.picture.values[i] = 0.5f * (filtered_a.values[i] + filtered_b.values[i]);
  const Image r = typical_values(a, b);
  Mean noisy, denoised;
  for (size_t i = 0; i < r.values.size(); i += 3) {
    double noisy_pixel = 0, pixel = 0;
    for (size_t k = i; k < i + 3; ++k) {
      const double weight = 1 / (3 * (squared(r.values[k]) + 0.01));
      const double fa = filtered_a.values[k], fb = filtered_b.values[k];
      // E (a - b)^2 is twice a half's variance.
      const double variance = squared(double(a.values[k]) - b.values[k]) / 2;
      const double half = (squared(fa - b.values[k]) + squared(fb - a.values[k])) / 2 - variance;
      noisy_pixel += weight * variance / 2;
      // The mean of the filtered halves has half of one's variance and all of its bias.
      pixel += weight * (half - squared(fa - fb) / 4);
    }
    noisy.add(noisy_pixel);
    denoised.add(pixel);
  }
  const auto root = [](double x) { return std::sqrt(std::max(0.0, x)); };
  result.noisy_rel_rmse = root(noisy.value());
  result.rel_rmse = root(denoised.value());
  result.low = root(denoised.value() - 1.96 * denoised.error());
  result.high = root(denoised.value() + 1.96 * denoised.error());
  return result;
}

}  // namespace vernier
