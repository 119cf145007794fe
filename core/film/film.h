// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/zeroed_vector.h"
#include "vernier/image.h"

namespace vernier {

/// What one camera sample found.
struct FilmSample {
  Rgb radiance{0, 0, 0};
  float transparency = 0;   ///< how much of what lies behind the picture would show; not negative
  bool met_surface = true;  ///< false: the camera saw nothing but what lies behind all surfaces
};

/// Sums of samples per pixel, in double, kept in two halves whose samples are independent of each other:
/// their difference measures the error of their mean. One thread at a time may add to a given pixel.
///
/// Light may also come to a pixel by splats, from paths that begin at lights and end in any pixel: each half
/// has light paths of its own, and the mean over them is added to that of the half's samples.
class Film {
 public:
  static constexpr int halves = 2;

  /// Without alpha, transparency is not kept; without splats, no light path may bring any.
  Film(int width, int height, bool has_alpha = false, bool has_splats = false)
      : width_(width),
        height_(height),
        cells_(size_t(width) * height * halves),
        transparency_(has_alpha ? cells_.size() : 0),
        splats_(has_splats ? cells_.size() : 0) {}

  /// A sample that is not finite or is negative in any channel is not stored; returns false for it.
  [[nodiscard]] bool add(int x, int y, int half, const FilmSample& sample) {
    const Rgb& radiance = sample.radiance;
    const float smallest = std::min(radiance.x, std::min(radiance.y, radiance.z));
    if (!(smallest >= 0) || !is_finite(radiance)) return false;
    if (has_alpha()) {
      if (!(sample.transparency >= 0) || !std::isfinite(sample.transparency)) return false;
      transparency_[index(x, y, half)] += double(sample.transparency);
    }
    Cell& cell = cells_[index(x, y, half)];
    cell.met_surface |= uint32_t(sample.met_surface);
    const Vec3d value(radiance);
    cell.sum += value;
    cell.sum_of_squares += value * value;
    cell.largest = std::max(cell.largest, max_component(radiance));
    ++cell.count;
    return true;
  }
  /// The same of a sample of an opaque surface.
  [[nodiscard]] bool add(int x, int y, int half, const Rgb& radiance) {
    return add(x, y, half, FilmSample{radiance});
  }

  /// All that one light path brings to a pixel, finite and not negative, of a film with splats.
  void splat(int x, int y, int half, const Rgb& radiance) {
    Cell& cell = splats_[index(x, y, half)];
    const Vec3d value(radiance);
    cell.sum += value;
    cell.sum_of_squares += value * value;
    cell.largest = std::max(cell.largest, max_component(radiance));
    ++cell.count;
  }
  /// So many more light paths were followed, whatever they brought.
  void count_light_paths(int half, uint64_t paths) { light_paths_[size_t(half)] += paths; }

  /// Sets what is added to the means of the halves from now on, by pixel and half: what a reconstruction from
  /// other knowledge than a pixel's own samples makes of them (GradientFilm). Errors of neighboring pixels
  /// then go together. It is no part of bytes().
  void correct(std::vector<Vec3f> corrections) { corrections_ = std::move(corrections); }
  bool is_reconstructed() const { return !corrections_.empty(); }

  /// Adds the samples of another film of the same size, each half to its own. The halves stay independent
  /// when the other film's samples are independent of these.
  void merge(const Film& other);

  int width() const { return width_; }
  int height() const { return height_; }
  bool has_alpha() const { return !transparency_.empty(); }
  bool has_splats() const { return !splats_.empty(); }
  const std::array<uint64_t, halves>& light_paths() const { return light_paths_; }

  uint32_t samples(int x, int y, int half) const { return cells_[index(x, y, half)].count; }
  uint32_t samples(int x, int y) const { return samples(x, y, 0) + samples(x, y, 1); }

  /// Mean of one half's samples, zero where there are none, what its splats add, and its correction.
  Vec3d half_mean(int x, int y, int half) const;
  /// Of its samples alone.
  Vec3d sample_mean(int x, int y, int half) const;
  /// What splats add.
  Vec3d splat_mean(int x, int y, int half) const;
  /// Variance that the mean of one half would have if its samples were independent: an upper bound in
  /// practice, since they are stratified. Zero with fewer than two samples.
  Vec3d half_mean_variance(int x, int y, int half) const;
  /// Variance of a single sample of the pixel, from the spread of the samples within each half. Zero while
  /// neither half has two samples. Splats count with the light paths that there are for a sample.
  Vec3d sample_variance(int x, int y) const;

  /// The pixel: the mean of the two halves' means, so that its weights do not depend on the samples even when
  /// the number of samples does; of the first half alone while the second has none.
  Vec3d pixel(int x, int y) const;
  /// How much of what lies behind it the pixel hides, in [0, 1], weighted like pixel(), which holds the
  /// colour times it. 1 on a film without alpha; 0 without samples on one with it.
  double alpha(int x, int y) const;
  /// Whether any sample of the pixel met a surface.
  bool is_covered(int x, int y) const {
    return cells_[index(x, y, 0)].met_surface || cells_[index(x, y, 1)].met_surface;
  }
  /// One channel: 1 where it is, else 0.
  Image coverage() const;
  /// Part of the sum of all samples, or of what splats add to it, that the largest one makes up, in [0, 1];
  /// the brightest channel counts.
  double largest_share(int x, int y) const;

  /// All pixels: three channels, linear Rec.709; zero where there are no samples.
  Image image() const;

  /// All that is known, to be stored and read back by the same version of the program on the same kind of
  /// machine.
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(cells_)); }
  std::span<std::byte> bytes() { return std::as_writable_bytes(std::span(cells_)); }
  /// The rest of it; empty without alpha.
  std::span<const std::byte> alpha_bytes() const { return std::as_bytes(std::span(transparency_)); }
  std::span<std::byte> alpha_bytes() { return std::as_writable_bytes(std::span(transparency_)); }
  /// What splats have brought; empty without.
  std::span<const std::byte> splat_bytes() const { return std::as_bytes(std::span(splats_)); }
  std::span<std::byte> splat_bytes() { return std::as_writable_bytes(std::span(splats_)); }
  static constexpr size_t bytes_per_pixel() { return halves * sizeof(Cell); }
  static constexpr size_t splat_bytes_per_pixel() { return halves * sizeof(Cell); }
  static constexpr size_t correction_bytes_per_pixel() { return halves * sizeof(Vec3f); }
  static constexpr size_t alpha_bytes_per_pixel() { return halves * sizeof(double); }
  /// Whether add() can have led to these sums; false only of damaged bytes.
  bool is_plausible() const;

 private:
  struct Cell {
    Vec3d sum{0, 0, 0};
    Vec3d sum_of_squares{0, 0, 0};
    uint32_t count : 31 = 0;
    uint32_t met_surface : 1 = 0;
    float largest = 0;
  };
  /// Sum of the squared distances of so many samples to their mean.
  static Vec3d spread(const Cell& cell, double count);
  static bool is_plausible(const Cell& cell);
  Vec3d splat_mean_variance(int x, int y, int half) const;
  size_t index(int x, int y, int half) const { return (size_t(y) * width_ + x) * halves + half; }

  int width_, height_;
  ZeroedVector<Cell> cells_;
  ZeroedVector<double> transparency_;  ///< sums, by cell; empty without alpha
  ZeroedVector<Cell> splats_;          ///< by cell, of the light paths that have brought any; empty without
  std::array<uint64_t, halves> light_paths_{};
  std::vector<Vec3f> corrections_;  ///< by cell; empty without
};

}  // namespace vernier
