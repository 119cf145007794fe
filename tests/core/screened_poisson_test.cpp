// SPDX-License-Identifier: Apache-2.0
#include "core/film/screened_poisson.h"

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "tests/support/random.h"

namespace vernier::test {
namespace {

PixelDifferences random_lack(int width, int height, uint64_t seed) {
  PixelDifferences lack{Image(width, height, 3), Image(width, height, 3)};
  Random random(seed);
  for (Image* image : {&lack.right, &lack.down})
    for (float& value : image->values) value = random.next1() - 0.5f;
  return lack;
}

// What it must make least has no slope there: screen c + the sum over neighbors of c less theirs is what the
// differences lack, of each pixel.
TEST(ScreenedPoisson, SolvesItsEquation) {
  for (const auto& [width, height] : {std::pair(9, 7), std::pair(1, 5), std::pair(6, 1), std::pair(1, 1)})
    for (const float screen : {0.04f, 0.3f, 2.f}) {
      const PixelDifferences lack = random_lack(width, height, 3);
      const Image c = solve_screened_poisson(lack, screen);
      const auto slope = [&](int x, int y, int k) {
        double sum = double(screen) * double(c.pixel(x, y)[k]);
        const auto side = [&](int i, int j, double wanted) {
          sum += double(c.pixel(x, y)[k]) - double(c.pixel(i, j)[k]) + wanted;
        };
        if (x > 0) side(x - 1, y, -double(lack.right.pixel(x - 1, y)[k]));
        if (x + 1 < c.width) side(x + 1, y, double(lack.right.pixel(x, y)[k]));
        if (y > 0) side(x, y - 1, -double(lack.down.pixel(x, y - 1)[k]));
        if (y + 1 < c.height) side(x, y + 1, double(lack.down.pixel(x, y)[k]));
        return sum;
      };
      for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x)
          for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(slope(x, y, k), 0, 1e-4) << c.width << "x" << c.height << ", " << screen;
    }
}

TEST(ScreenedPoisson, SameForAnyNumberOfThreads) {
  const PixelDifferences lack = random_lack(40, 33, 5);
  std::vector<float> first;
  for (const unsigned threads : {1u, 2u, 7u}) {
    const ThreadLimit limit(threads);
    const Image c = solve_screened_poisson(lack, 0.3f);
    if (first.empty()) first = c.values;
    EXPECT_EQ(c.values, first) << threads;
  }
}

}  // namespace
}  // namespace vernier::test
