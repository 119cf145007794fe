#include "core/image/film.h"

namespace vernier {

int64_t Film::samples(int x, int y) const {
  int64_t total = 0;
  for (int g = 0; g < groups_; ++g) total += group_samples(x, y, g);
  return total;
}

Vec3d Film::group_mean(int x, int y, int group) const {
  const Cell& cell = cells_[index(x, y) + group];
  return cell.count ? cell.sum / double(cell.count) : Vec3d(0, 0, 0);
}

Image Film::mean() const {
  Image image(width_, height_, 3);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      Vec3d sum(0, 0, 0);
      int64_t count = 0;
      for (int g = 0; g < groups_; ++g) {
        const Cell& cell = cells_[index(x, y) + g];
        sum += cell.sum;
        count += cell.count;
      }
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = count ? float(sum[c] / double(count)) : 0.f;
    }
  return image;
}

}  // namespace vernier
