// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "vernier/math.h"

namespace vernier {

/// Calls visit(i, j) for the pixels of the square of side 2 radius + 1 around (x, y) that exist.
template <typename Picture, typename Visit>
void for_each_near(const Picture& picture, int x, int y, int radius, const Visit& visit) {
  for (int j = std::max(0, y - radius); j <= std::min(picture.height() - 1, y + radius); ++j)
    for (int i = std::max(0, x - radius); i <= std::min(picture.width() - 1, x + radius); ++i) visit(i, j);
}

/// What infinitely many samples would probably give of a pixel: the pixel drawn towards what is known of it
/// otherwise, prior(x, y), the more the noisier it is: by its variance against how much the truth departs
/// from `prior` here (empirical Bayes; Efron and Morris 1973, "Stein's Estimation Rule and Its Competitors").
/// The halves' errors are independent, so the product of their distances from it shows what is no noise.
/// `picture` is a Film or has of it: width(), height(), half_mean(x, y, half), pixel(x, y),
/// iid_variance(picture, x, y).
template <typename Picture, typename Prior>
Vec3d shrinkage_estimate(const Picture& picture, int x, int y, const Prior& prior) {
  Vec3d truth(0, 0, 0);
  int pixels = 0;
  for_each_near(picture, x, y, 1, [&](int i, int j) {
    const Vec3d expected = prior(i, j);
    truth += (picture.half_mean(i, j, 0) - expected) * (picture.half_mean(i, j, 1) - expected);
    ++pixels;
  });
  truth = max(truth / double(pixels), Vec3d(0, 0, 0));
  const Vec3d own = picture.pixel(x, y), expected = prior(x, y);
  const Vec3d noise = iid_variance(picture, x, y);
  Vec3d shrunk = own;
  for (int c = 0; c < 3; ++c)
    if (noise[c] > 0) shrunk[c] = expected[c] + truth[c] / (truth[c] + noise[c]) * (own[c] - expected[c]);
  return max(shrunk, Vec3d(0, 0, 0));
}

/// Mean of the up to eight pixels around; the pixel itself when there are none.
template <typename Picture>
Vec3d mean_around(const Picture& picture, int x, int y) {
  const Vec3d own = picture.pixel(x, y);
  Vec3d sum(0, 0, 0);
  int neighbors = -1;
  for_each_near(picture, x, y, 1, [&](int i, int j) {
    sum += picture.pixel(i, j);
    ++neighbors;
  });
  return neighbors == 0 ? own : (sum - own) / double(neighbors);
}

/// The same with nothing known otherwise but the pixels around.
template <typename Picture>
Vec3d shrinkage_estimate(const Picture& picture, int x, int y) {
  const Vec3d mean = mean_around(picture, x, y);
  return shrinkage_estimate(picture, x, y, [&](int, int) { return mean; });
}

}  // namespace vernier
