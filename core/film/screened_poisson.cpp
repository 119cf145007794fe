// SPDX-License-Identifier: Apache-2.0
#include "core/film/screened_poisson.h"

#include "core/base/parallel.h"

namespace vernier {
namespace {

/// Eigenvalues of the sum over neighbors of differences lie between 0 and this.
constexpr float largest_eigenvalue = 8;

/// Steps until what is left of an error is less than 1e-5: each multiplies it by (s - 1) / (s + 1), s being
/// the root of the largest eigenvalue over the least.
int step_count(float screen) {
  const float s = std::sqrt((largest_eigenvalue + screen) / screen);
  return int(std::ceil(std::log(0.5e-5f) / std::log((s - 1) / (s + 1))));
}

template <typename Body>
void for_each_pixel(const Image& image, const Body& body) {
  parallel_for(size_t(image.height), [&](size_t y) {
    for (int x = 0; x < image.width; ++x) body(x, int(y));
  });
}

/// What the wanted differences ask of each pixel: those that end there less those that begin there.
Image divergence(const PixelDifferences& d) {
  Image sum(d.right.width, d.right.height, 3);
  for_each_pixel(sum, [&](int x, int y) {
    float* to = sum.pixel(x, y);
    for (int c = 0; c < 3; ++c) {
      float value = 0;
      if (x > 0) value += d.right.pixel(x - 1, y)[c];
      if (x + 1 < sum.width) value -= d.right.pixel(x, y)[c];
      if (y > 0) value += d.down.pixel(x, y - 1)[c];
      if (y + 1 < sum.height) value -= d.down.pixel(x, y)[c];
      to[c] = value;
    }
  });
  return sum;
}

/// screen p + the sum over neighbors of p less theirs.
void subtract_applied(Image& residual, const Image& p, float screen, float scale) {
  for_each_pixel(p, [&](int x, int y) {
    const float* own = p.pixel(x, y);
    float* to = residual.pixel(x, y);
    for (int c = 0; c < 3; ++c) {
      float value = screen * own[c];
      if (x > 0) value += own[c] - p.pixel(x - 1, y)[c];
      if (x + 1 < p.width) value += own[c] - p.pixel(x + 1, y)[c];
      if (y > 0) value += own[c] - p.pixel(x, y - 1)[c];
      if (y + 1 < p.height) value += own[c] - p.pixel(x, y + 1)[c];
      to[c] -= scale * value;
    }
  });
}

}  // namespace

Image solve_screened_poisson(const PixelDifferences& lack, float screen) {
  Image residual = divergence(lack);
  Image solution(residual.width, residual.height, 3), direction(residual.width, residual.height, 3);
  const float middle = screen + largest_eigenvalue / 2, half_range = largest_eigenvalue / 2;
  float step = 0, carried = 0;
  for (int i = 0, steps = step_count(screen); i < steps; ++i) {
    if (i > 0) carried = square(half_range * step / 2) * (i == 1 ? 2.f : 1.f);
    step = i == 0 ? 1 / middle : 1 / (middle - carried / step);
    for_each_pixel(solution, [&](int x, int y) {
      for (int c = 0; c < 3; ++c) {
        float& along = direction.pixel(x, y)[c];
        along = residual.pixel(x, y)[c] + carried * along;
        solution.pixel(x, y)[c] += step * along;
      }
    });
    subtract_applied(residual, direction, screen, step);
  }
  return solution;
}

}  // namespace vernier
