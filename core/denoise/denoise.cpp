// SPDX-License-Identifier: Apache-2.0
#include "core/denoise/denoise.h"

#include <array>
#include <cmath>

#include "core/base/names.h"
#include "core/base/parallel.h"
#include "core/compare/metrics.h"
#include "core/denoise/convolve.h"
#include "core/denoise/denoise_filters.h"
#include "core/denoise/oidn_library.h"
#include "core/film/shrinkage.h"
#include "vernier/error.h"

namespace vernier {
namespace {

constexpr Denoiser table[] = {
    {"nlm", "non-local means: averages pixels whose surroundings look alike, given the noise", denoise_nlm},
    {"bilateral", "averages neighbors whose colours differ no more than their noise", denoise_bilateral},
    {"gaussian", "averages neighbors by distance, as far as the noise explains the change", denoise_gaussian},
    {"median", "median of the 5 x 5 pixels around, as far as the noise explains the change", denoise_median},
    {"oidn", "Open Image Denoise, a trained network; does not use the error layer", denoise_oidn, true},
};

constexpr int block = 32;  // pixels a side: wider than any filter's window
constexpr int pool = 15;   // pixels a side over which the noise that is left is averaged
constexpr int spread_pool =
    5;  // pixels a side whose mean variance says what a pixel's is at least: a quarter

/// Two independent measurements of one picture, as shrinkage_estimate wants them.
struct Halves {
  Image first, second;
  Image variance;  ///< of each value of their mean

  int width() const { return first.width; }
  int height() const { return first.height; }
  Vec3d half_mean(int x, int y, int half) const { return Vec3d(rgb_at(half == 0 ? first : second, x, y)); }
  Vec3d pixel(int x, int y) const { return (half_mean(x, y, 0) + half_mean(x, y, 1)) / 2.0; }
};

Vec3d iid_variance(const Halves& halves, int x, int y) { return Vec3d(rgb_at(halves.variance, x, y)); }

/// Finite everywhere. Where there are no error layers no variance is known, and the pixels stand for the
/// truth.
Halves noisy_halves(const NoisyImage& first, const NoisyImage& second) {
  Halves halves{fill_not_finite(first.color), fill_not_finite(second.color),
                Image(first.color.width, first.color.height, 3)};
  for (const NoisyImage* half : {&first, &second})
    if (half->error) {
      const Image error = fill_not_finite(*half->error);
      for (size_t i = 0; i < error.values.size(); ++i)
        halves.variance.values[i] += square(error.values[i]) / 4;
    }
  // Few samples may all have missed the light, and then say that they have no noise at all.
  const std::vector<float> around(spread_pool, 1.f / spread_pool);
  const Image mean = convolve(halves.variance, around, around);
  for (size_t i = 0; i < mean.values.size(); ++i)
    halves.variance.values[i] = std::max(halves.variance.values[i], mean.values[i] / 4);
  return halves;
}

Halves filtered_halves(Image first, Image second) {
  Halves halves{std::move(first), std::move(second), {}};
  halves.variance = halves.first;
  for (size_t i = 0; i < halves.variance.values.size(); ++i)
    halves.variance.values[i] = square((halves.first.values[i] - halves.second.values[i]) / 2);
  return halves;
}

template <typename Value>
Image picture_of(int width, int height, const Value& value) {
  Image image(width, height, 3);
  parallel_for(size_t(height), [&](size_t y) {
    for (int x = 0; x < width; ++x) {
      const Vec3d v = value(x, int(y));
      for (int c = 0; c < 3; ++c) image.pixel(x, int(y))[c] = float(v[c]);
    }
  });
  return image;
}

/// Whether one is more than four times the other; neither is negative.
bool far_apart(double a, double b) { return std::max(a, b) > 4 * std::min(a, b); }

/// The filtered value; where its halves are far apart one has kept what a single sample brought, and it is no
/// more than its neighbors' mean.
Vec3d agreed_value(const Halves& filtered, int x, int y) {
  const Vec3d first = filtered.half_mean(x, y, 0), second = filtered.half_mean(x, y, 1);
  const Vec3d around = mean_around(filtered, x, y);
  Vec3d value = filtered.pixel(x, y);
  for (int c = 0; c < 3; ++c)
    if (far_apart(first[c], second[c])) value[c] = std::min(value[c], around[c]);
  return value;
}

/// The squares of a value's relative errors are its squared errors times this. For the truth stands what the
/// filtered halves agree on; where the noisy value is far from that, as much of it as both noisy halves saw.
/// (Nearer to it such weights would go with the errors that they weigh.) A light that only one half saw would
/// count as many times itself: a sixth of the noisy value is the least.
Image relative_weights(const Halves& noisy, const Halves& filtered) {
  constexpr double least = 1.0 / 6;
  const int width = noisy.width(), height = noisy.height();
  const Image agreed = picture_of(width, height, [&](int x, int y) { return agreed_value(filtered, x, y); });
  const auto agreed_at = [&](int x, int y) { return Vec3d(rgb_at(agreed, x, y)); };
  return picture_of(width, height, [&](int x, int y) {
    const Vec3d own = noisy.pixel(x, y), shrunk = shrinkage_estimate(noisy, x, y, agreed_at);
    Vec3d value = agreed_at(x, y);
    for (int c = 0; c < 3; ++c)
      if (far_apart(own[c], value[c])) value[c] = shrunk[c];
    value = max(value, least * own);
    return Vec3d(1, 1, 1) / (value * value + Vec3d(relative_error_epsilon));
  });
}

/// Sums of the squared relative errors of the pixels of a block.
struct BlockSums {
  double noisy = 0, denoised = 0, pixels = 0;
};

/// Adds what one pixel says of its squared errors. What the filter has taken from one half is independent of
/// what it has taken from the other, and the expectation of both is what it blurs: so that squared is their
/// product. The variance that is left is that of the mean of the filtered halves.
void add_pixel(BlockSums& sums, const Halves& noisy, const Halves& filtered, const Image& weights, int x,
               int y) {
  const Vec3d a = noisy.half_mean(x, y, 0), b = noisy.half_mean(x, y, 1);
  const Vec3d fa = filtered.half_mean(x, y, 0), fb = filtered.half_mean(x, y, 1);
  const Vec3d weight(rgb_at(weights, x, y)), apart = (a - b) / 2.0;
  sums.noisy += dot(weight, apart * apart) / 3;
  sums.denoised += dot(weight, (fa - a) * (fb - b) + iid_variance(filtered, x, y)) / 3;
  ++sums.pixels;
}

/// One channel: 1 where a pixel counts, else 0.
Image counted_pixels(const NoisyImage& picture) {
  Image counted(picture.color.width, picture.color.height, 1);
  std::fill(counted.values.begin(), counted.values.end(), 1.f);
  if (!picture.coverage) return counted;
  const std::vector<float>& covered = picture.coverage->values;
  const auto is_covered = [](float part) { return part > 0; };
  if (std::any_of(covered.begin(), covered.end(), is_covered))
    std::transform(covered.begin(), covered.end(), counted.values.begin(), is_covered);
  return counted;
}

std::vector<BlockSums> block_sums(const Halves& noisy, const Halves& filtered, const Image& weights,
                                  const Image& counted) {
  const int columns = (noisy.width() + block - 1) / block, rows = (noisy.height() + block - 1) / block;
  std::vector<BlockSums> sums(size_t(columns) * size_t(rows));
  for (int y = 0; y < noisy.height(); ++y)
    for (int x = 0; x < noisy.width(); ++x)
      if (*counted.pixel(x, y) > 0)
        add_pixel(sums[size_t(y / block) * size_t(columns) + size_t(x / block)], noisy, filtered, weights, x,
                  y);
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
  for (const BlockSums& sums : blocks) {
    const double off = sums.denoised - mean * sums.pixels;
    spread += off * off;
  }
  const auto n = double(
      std::count_if(blocks.begin(), blocks.end(), [](const BlockSums& sums) { return sums.pixels > 0; }));
  const double error = n > 1 ? std::sqrt(spread * n / (n - 1)) / total.pixels : std::abs(mean);
  const auto root = [](double x) { return std::sqrt(std::max(0.0, x)); };
  return {root(total.noisy / total.pixels), root(mean), root(mean - 1.96 * error), root(mean + 1.96 * error)};
}

/// The variance that is left, averaged about each pixel as a part of what the error is relative to, lest a
/// lamp's is its dark surroundings', times one factor for the whole picture: its squared error over that
/// variance, which lacks what the filter has blurred.
Image pixel_errors(const Image& variance, const Image& weights, const Image& counted, double rel_rmse) {
  Image left = variance;
  double sum = 0, count = 0;
  for (size_t i = 0; i < left.values.size(); ++i) {
    left.values[i] *= weights.values[i];
    sum += left.values[i] * counted.values[i / 3];
    count += counted.values[i / 3];
  }
  const double total = rel_rmse * rel_rmse * count;
  const double factor = sum > 0 ? std::max(1.0, total / sum) : 1;
  const std::vector<float> mean(pool, 1.f / pool);
  left = convolve(left, mean, mean);
  for (size_t i = 0; i < left.values.size(); ++i)
    left.values[i] = float(std::sqrt(factor * left.values[i] / weights.values[i]));
  return left;
}

}  // namespace

std::span<const Denoiser> denoisers() {
  // The last one is somebody else's library, which may not be there.
  return std::span(table).first(std::size(table) - (OidnLibrary::find() ? 0 : 1));
}

std::vector<std::string> denoiser_names() {
  std::vector<std::string> names{"auto"};
  for (const Denoiser& denoiser : table) names.emplace_back(denoiser.name);
  return names;
}

size_t denoise_bytes_per_pixel() {
  constexpr size_t image = 3 * sizeof(float);
  constexpr size_t given =
      4 + 4 + 2 * 4;  // a NoisyImage, the halves with their spreads, each half's NoisyImage
  constexpr size_t guided = 1 + 1 + 2 + 1;     // color, variance, features and modulation of a GuidedImage
  constexpr size_t filtering = 1 + 1 + 2 + 1;  // its color, variance and features as planes, and the result
  constexpr size_t filtered = 1;               // the other half
  constexpr size_t coverage = 3 + 1;           // channels: of each NoisyImage, and which pixels count
  return (given + guided + filtering + filtered) * image + coverage * sizeof(float);
}

const Denoiser& find_denoiser(std::string_view name) {
  const bool is_auto = name == "auto";
  if (is_auto && OidnLibrary::find()) return *std::prev(std::end(table));
  if (is_auto && !OidnLibrary::is_named()) return *std::begin(table);
  if ((is_auto || name == "oidn") && !OidnLibrary::find())
    throw Error(ErrorKind::usage, "no filter 'oidn' here: " + OidnLibrary::why_not_found());
  return find_by_name(denoisers(), "filter", name);
}

DenoisedHalves denoise_halves(const Denoiser& denoiser, const NoisyImage& first, const NoisyImage& second) {
  if (first.color.width != second.color.width || first.color.height != second.color.height)
    throw Error(ErrorKind::usage, "the two halves of a picture to denoise differ in size");
  const Halves filtered = filtered_halves(denoiser.filter(first), denoiser.filter(second));
  const Halves noisy = noisy_halves(first, second);
  const Image weights = relative_weights(noisy, filtered);
  DenoisedHalves result;
  result.picture =
      picture_of(noisy.width(), noisy.height(), [&](int x, int y) { return filtered.pixel(x, y); });
  const Image counted = counted_pixels(first);
  result.error = estimate(block_sums(noisy, filtered, weights, counted));
  result.pixel_error = pixel_errors(filtered.variance, weights, counted, result.error.rel_rmse);
  return result;
}

}  // namespace vernier
