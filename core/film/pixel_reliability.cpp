// SPDX-License-Identifier: Apache-2.0
#include "core/film/pixel_reliability.h"

#include "core/base/parallel.h"
#include "core/compare/metrics.h"
#include "core/film/shrinkage.h"

namespace vernier {
namespace {

constexpr uint32_t min_samples = 8;            // fewer say too little about a pixel's tail
constexpr double heavy_share = 0.25;           // of a pixel's light in one sample
constexpr double outlier_variance_ratio = 30;  // times what is usual around the pixel
constexpr double common_outlier_share = 0.05;  // of a neighbourhood's pixels
constexpr double min_log_variance = 1e-8;      // relative; keeps logarithms finite

double log_relative_variance(const Film& film, const Image& shrunk, int x, int y) {
  const Vec3d variance = iid_variance(film, x, y);
  double sum = 0;
  for (int c = 0; c < 3; ++c) sum += relative_squared(variance[c], shrunk.pixel(x, y)[c]) / 3;
  return std::log(sum + min_log_variance);
}

/// Whether a single sample makes the pixel something else than what is usual around it.
bool is_outlier(const Film& film, const Image& log_variance, int x, int y) {
  if (film.samples(x, y) < min_samples) return true;
  if (film.largest_share(x, y) <= heavy_share) return false;
  const double own = *log_variance.pixel(x, y);
  double sum = -own;
  int neighbors = -1;
  for_each_near(film, x, y, 2, [&](int i, int j) {
    sum += *log_variance.pixel(i, j);
    ++neighbors;
  });
  return neighbors == 0 || own - sum / neighbors > std::log(outlier_variance_ratio);
}

template <typename Body>
void for_each_pixel(const Film& film, const Body& body) {
  parallel_for(size_t(film.height()), [&](size_t row) {
    for (int x = 0; x < film.width(); ++x) body(x, int(row));
  });
}

}  // namespace

Vec3d squared_half_difference(const Film& film, int x, int y) {
  const Vec3d d = (film.half_mean(x, y, 0) - film.half_mean(x, y, 1)) / 2.0;
  return d * d;
}

namespace {

/// The samples' spread says nothing of what is made from them; only the halves do. Their difference in one
/// pixel is known by one degree of freedom, so that of pixels around is taken with it, if they are about as
/// bright: beside a lamp's edge the wall has no part in its noise.
Vec3d reconstructed_variance(const Film& film, int x, int y) {
  constexpr double alike = 2, darkest = 0.02;
  const auto brightness = [&](int i, int j) { return luminance(Rgb(Vec3f(film.pixel(i, j)))) + darkest; };
  const double own = brightness(x, y);
  Vec3d sum(0, 0, 0);
  int pixels = 0;
  for_each_near(film, x, y, 1, [&](int i, int j) {
    const double there = brightness(i, j);
    if (there > alike * own || own > alike * there) return;
    sum += squared_half_difference(film, i, j);
    ++pixels;
  });
  return pixels > 0 ? sum / double(pixels) : squared_half_difference(film, x, y);
}

}  // namespace

Vec3d iid_variance(const Film& film, int x, int y) {
  if (film.is_reconstructed()) return reconstructed_variance(film, x, y);
  return (film.half_mean_variance(x, y, 0) + film.half_mean_variance(x, y, 1)) / 4.0;
}

size_t assess_pixels_bytes_per_pixel() {
  return (3 + 1) * sizeof(float)     // the result
         + (1 + 1) * sizeof(float);  // log_variance and outlier
}

PixelReliability assess_pixels(const Film& film) {
  const int width = film.width(), height = film.height();
  PixelReliability reliability{Image(width, height, 3), Image(width, height, 1)};
  Image log_variance(width, height, 1), outlier(width, height, 1);
  for_each_pixel(film, [&](int x, int y) {
    const Vec3d shrunk = shrinkage_estimate(film, x, y);
    for (int c = 0; c < 3; ++c) reliability.shrunk_mean.pixel(x, y)[c] = float(shrunk[c]);
    *log_variance.pixel(x, y) = float(log_relative_variance(film, reliability.shrunk_mean, x, y));
  });
  for_each_pixel(
      film, [&](int x, int y) { *outlier.pixel(x, y) = is_outlier(film, log_variance, x, y) ? 1.f : 0.f; });
  // Where such samples are found here and there, the other pixels may owe light to some not yet drawn.
  for_each_pixel(film, [&](int x, int y) {
    int found = 0, pixels = 0;
    for_each_near(film, x, y, 3, [&](int i, int j) {
      found += *outlier.pixel(i, j) != 0;
      ++pixels;
    });
    const bool unreliable = *outlier.pixel(x, y) != 0 || found > common_outlier_share * pixels;
    *reliability.unreliable.pixel(x, y) = unreliable ? 1.f : 0.f;
  });
  return reliability;
}

}  // namespace vernier
