// SPDX-License-Identifier: Apache-2.0
#include "core/film/film.h"

#include <algorithm>
#include <cmath>

namespace vernier {

void Film::merge(const Film& other) {
  for (size_t i = 0; i < cells_.size(); ++i) {
    Cell& cell = cells_[i];
    const Cell& more = other.cells_[i];
    cell.sum += more.sum;
    cell.sum_of_squares += more.sum_of_squares;
    cell.count += more.count;
    cell.met_surface |= more.met_surface;
    cell.largest = std::max(cell.largest, more.largest);
  }
  for (size_t i = 0; i < transparency_.size(); ++i) transparency_[i] += other.transparency_[i];
}

bool Film::is_plausible() const {
  const auto is_sum = [](double value) { return value >= 0 && std::isfinite(value); };
  if (!std::all_of(transparency_.begin(), transparency_.end(), is_sum)) return false;
  return std::all_of(cells_.begin(), cells_.end(), [&](const Cell& cell) {
    bool plausible = is_sum(cell.largest) && cell.count <= uint32_t{1} << 30;
    for (int c = 0; c < 3; ++c)
      plausible = plausible && is_sum(cell.sum[c]) && is_sum(cell.sum_of_squares[c]);
    return plausible;
  });
}

Vec3d Film::half_mean(int x, int y, int half) const {
  const Cell& cell = cells_[index(x, y, half)];
  return cell.count ? cell.sum / double(cell.count) : Vec3d(0, 0, 0);
}

Vec3d Film::spread(const Cell& cell) {
  if (cell.count < 2) return {0, 0, 0};
  return max(cell.sum_of_squares - cell.sum * cell.sum / double(cell.count), Vec3d(0, 0, 0));
}

Vec3d Film::half_mean_variance(int x, int y, int half) const {
  const Cell& cell = cells_[index(x, y, half)];
  if (cell.count < 2) return {0, 0, 0};
  const double n = cell.count;
  return spread(cell) / ((n - 1) * n);
}

Vec3d Film::sample_variance(int x, int y) const {
  Vec3d sum(0, 0, 0);
  double degrees = 0;
  for (int half = 0; half < halves; ++half) {
    const Cell& cell = cells_[index(x, y, half)];
    sum += spread(cell);
    degrees += std::max(1.0, double(cell.count)) - 1;
  }
  return degrees > 0 ? sum / degrees : sum;
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
  const Vec3d sum = a.sum + b.sum;
  const double total = std::max(sum.x, std::max(sum.y, sum.z));
  return total > 0 ? std::max(a.largest, b.largest) / total : 0;
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
