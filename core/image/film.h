#pragma once

#include <cstdint>
#include <vector>

#include "core/image/image.h"

namespace vernier {

/// Sums of samples per pixel, in double, split into `groups` that are statistically independent of each other, so
/// that their spread measures the error of the mean. One thread at a time may add to a given pixel.
class Film {
 public:
  Film(int width, int height, int groups = 1)
      : width_(width), height_(height), groups_(groups), cells_(size_t(width) * height * groups) {}

  /// A sample that is not finite or is negative in any channel is not stored; returns false for it.
  [[nodiscard]] bool add(int x, int y, int group, const Rgb& radiance) {
    const float smallest = std::min(radiance.x, std::min(radiance.y, radiance.z));
    if (!(smallest >= 0) || !is_finite(radiance)) return false;
    Cell& cell = cells_[index(x, y) + group];
    cell.sum += Vec3d(radiance);
    ++cell.count;
    return true;
  }

  int width() const { return width_; }
  int height() const { return height_; }
  int groups() const { return groups_; }

  int64_t samples(int x, int y) const;
  int64_t group_samples(int x, int y, int group) const { return cells_[index(x, y) + group].count; }
  /// Mean of one group's samples; zero where there are none.
  Vec3d group_mean(int x, int y, int group) const;

  /// Mean of all samples of each pixel: three channels, linear Rec.709; zero where there are none.
  Image mean() const;

 private:
  struct Cell {
    Vec3d sum{0, 0, 0};
    int64_t count = 0;
  };
  size_t index(int x, int y) const { return (size_t(y) * width_ + x) * groups_; }

  int width_, height_, groups_;
  std::vector<Cell> cells_;
};

}  // namespace vernier
