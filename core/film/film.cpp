// SPDX-License-Identifier: Apache-2.0
#include "core/film/film.h"

#include <algorithm>
#include <cmath>

namespace vernier {

void Film::merge(const Film& other) {
  corrections_.clear();
  const auto merge_cells = [](ZeroedVector<Cell>& cells, const ZeroedVector<Cell>& others) {
    for (size_t i = 0; i < cells.size(); ++i) {
      Cell& cell = cells[i];
      const Cell& more = others[i];
      cell.sum += more.sum;
      cell.sum_of_squares += more.sum_of_squares;
      cell.count += more.count;
      cell.met_surface |= more.met_surface;
      cell.largest = std::max(cell.largest, more.largest);
    }
  };
  merge_cells(cells_, other.cells_);
  merge_cells(splats_, other.splats_);
  for (size_t half = 0; half < halves; ++half) light_paths_[half] += other.light_paths_[half];
  for (size_t i = 0; i < transparency_.size(); ++i) transparency_[i] += other.transparency_[i];
}

bool Film::is_plausible(const Cell& cell) {
  const auto is_sum = [](double value) { return value >= 0 && std::isfinite(value); };
  bool plausible = is_sum(cell.largest);
  for (int c = 0; c < 3; ++c) plausible = plausible && is_sum(cell.sum[c]) && is_sum(cell.sum_of_squares[c]);
  return plausible;
}

bool Film::is_plausible() const {
  const auto is_sum = [](double value) { return value >= 0 && std::isfinite(value); };
  if (!std::all_of(transparency_.begin(), transparency_.end(), is_sum)) return false;
  const auto is_sample_cell = [](const Cell& cell) {
    return is_plausible(cell) && cell.count <= uint32_t{1} << 30;
  };
  const auto is_splat_cell = [](const Cell& cell) { return is_plausible(cell); };
  return std::all_of(cells_.begin(), cells_.end(), is_sample_cell) &&
         std::all_of(splats_.begin(), splats_.end(), is_splat_cell);
}

Vec3d Film::sample_mean(int x, int y, int half) const {
  const Cell& cell = cells_[index(x, y, half)];
  return cell.count ? cell.sum / double(cell.count) : Vec3d(0, 0, 0);
}

Vec3d Film::half_mean(int x, int y, int half) const {
  Vec3d mean = sample_mean(x, y, half);
  if (is_reconstructed()) mean += Vec3d(corrections_[index(x, y, half)]);
  return has_splats() ? mean + splat_mean(x, y, half) : mean;
}

Vec3d Film::splat_mean(int x, int y, int half) const {
  const uint64_t paths = light_paths_[size_t(half)];
  return has_splats() && paths > 0 ? splats_[index(x, y, half)].sum / double(paths) : Vec3d(0, 0, 0);
}

/// Most light paths bring nothing to a pixel, which counts like any other value.
Vec3d Film::splat_mean_variance(int x, int y, int half) const {
  const uint64_t paths = light_paths_[size_t(half)];
  if (!has_splats() || paths < 2) return {0, 0, 0};
  const auto n = double(paths);
  return spread(splats_[index(x, y, half)], n) / ((n - 1) * n);
}

Vec3d Film::spread(const Cell& cell, double count) {
  if (count < 2) return {0, 0, 0};
  return max(cell.sum_of_squares - cell.sum * cell.sum / count, Vec3d(0, 0, 0));
}

Vec3d Film::half_mean_variance(int x, int y, int half) const {
  const Cell& cell = cells_[index(x, y, half)];
  const Vec3d splatted = splat_mean_variance(x, y, half);
  if (cell.count < 2) return splatted;
  const double n = cell.count;
  return spread(cell, n) / ((n - 1) * n) + splatted;
}

Vec3d Film::sample_variance(int x, int y) const {
  Vec3d sum(0, 0, 0), splatted(0, 0, 0);
  double degrees = 0;
  for (int half = 0; half < halves; ++half) {
    const Cell& cell = cells_[index(x, y, half)];
    sum += spread(cell, cell.count);
    degrees += std::max(1.0, double(cell.count)) - 1;
    splatted += splat_mean_variance(x, y, half) * (double(cell.count) / halves);
  }
  return (degrees > 0 ? sum / degrees : sum) + splatted;
}

Vec3d Film::pixel(int x, int y) const {
  if (samples(x, y, 1) == 0) return half_mean(x, y, 0);
  if (samples(x, y, 0) == 0) return half_mean(x, y, 1);
  return (half_mean(x, y, 0) + half_mean(x, y, 1)) / 2.0;
}

double Film::alpha(int x, int y) const {
  if (!has_alpha()) return 1;
  double transparency = 0;
  int sampled = 0;
  for (int half = 0; half < halves; ++half) {
    if (samples(x, y, half) == 0) continue;
    transparency += transparency_[index(x, y, half)] / samples(x, y, half);
    ++sampled;
  }
  return sampled == 0 ? 0 : std::clamp(1 - transparency / sampled, 0.0, 1.0);
}

double Film::largest_share(int x, int y) const {
  const Cell& a = cells_[index(x, y, 0)];
  const Cell& b = cells_[index(x, y, 1)];
  Vec3d sum = a.sum + b.sum;
  double largest = std::max(a.largest, b.largest);
  if (has_splats()) {
    // What a light path adds to the mean of a half counts as a sample that would add as much.
    for (int half = 0; half < halves; ++half) {
      const double weight =
          double(samples(x, y, half)) / double(std::max<uint64_t>(1, light_paths_[size_t(half)]));
      const Cell& cell = splats_[index(x, y, half)];
      sum += cell.sum * weight;
      largest = std::max(largest, cell.largest * weight);
    }
  }
  const double total = std::max(sum.x, std::max(sum.y, sum.z));
  return total > 0 ? largest / total : 0;
}

Image Film::coverage() const {
  Image covered(width_, height_, 1);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) *covered.pixel(x, y) = is_covered(x, y) ? 1.f : 0.f;
  return covered;
}

Image Film::image() const {
  Image image(width_, height_, 3);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const Vec3d value = pixel(x, y);
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = float(value[c]);
    }
  return image;
}

}  // namespace vernier
