// SPDX-License-Identifier: Apache-2.0
#include "core/film/gradient_film.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace vernier {
namespace {

/// How much a pixel's own mean counts beside its differences, the square of alpha of Lehtinen et al. (2013,
/// "Gradient-Domain Metropolis Light Transport"). Where differences are known well a smaller one
/// leaves less noise in single pixels; the noise of large areas grows as it falls. In a kitchen, 0.1 to 0.5
/// are alike; in the Cornell box the variance of a pixel doubles from 0.1 to 0.6, that of 8 x 8 means falls
/// by a third.
constexpr float screen = 0.2f;

}  // namespace

void GradientFilm::reconstruct(Film& film) const {
  const int width = film.width(), height = film.height();
  film.correct({});  // its memory is needed
  std::vector<Vec3f> corrections(size_t(width) * height * Film::halves);
  for (int half = 0; half < Film::halves; ++half) {
    const auto cell = [&](int x, int y) -> const Cell& {
      return cells_[(size_t(y) * width + x) * Film::halves + half];
    };
    const auto samples = [&](int x, int y) { return std::max(1.0, double(film.samples(x, y, half))); };
    const auto primal = [&](int x, int y) {
      return film.sample_mean(x, y, half) - cell(x, y).primal_only / samples(x, y);
    };
    PixelDifferences lack{Image(width, height, 3), Image(width, height, 3)};
    const auto put = [&](Image& image, int x, int y, size_t there) {
      const int i = x + PixelNeighbors::dx[there], j = y + PixelNeighbors::dy[there];
      if (i >= width || j >= height) return;
      // What the neighbor tells is its own less this one's.
      const Vec3d wanted =
          cell(x, y).differences[there] / samples(x, y) - cell(i, j).differences[there + 1] / samples(i, j);
      const Vec3d missing = wanted - (primal(i, j) - primal(x, y));
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = float(missing[c]);
    };
    parallel_for(size_t(height), [&](size_t y) {
      for (int x = 0; x < width; ++x) {
        put(lack.right, x, int(y), 0);
        put(lack.down, x, int(y), 2);
      }
    });
    const Image correction = solve_screened_poisson(lack, screen);
    for (size_t i = 0; i < size_t(width) * height; ++i) {
      const float* c = &correction.values[3 * i];
      corrections[i * Film::halves + size_t(half)] = {c[0], c[1], c[2]};
    }
  }
  film.correct(std::move(corrections));
}

bool GradientFilm::is_plausible() const {
  const auto is_sum = [](const Vec3d& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  return std::all_of(cells_.begin(), cells_.end(), [&](const Cell& cell) {
    return is_sum(cell.primal_only) && std::all_of(cell.differences.begin(), cell.differences.end(), is_sum);
  });
}

void GradientFilm::merge(const GradientFilm& other) {
  for (size_t i = 0; i < cells_.size(); ++i) {
    cells_[i].primal_only += other.cells_[i].primal_only;
    for (size_t k = 0; k < PixelNeighbors::count; ++k)
      cells_[i].differences[k] += other.cells_[i].differences[k];
  }
}

}  // namespace vernier
