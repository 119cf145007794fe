// SPDX-License-Identifier: Apache-2.0
#include "core/denoise/convolve.h"

#include <gtest/gtest.h>

#include "core/display/colormap.h"

namespace vernier {
namespace {

TEST(Convolve, MatchesTheSumsWrittenOut) {
  Image image(7, 5, 2);
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = float((i * 7) % 11) - 3;
  const std::vector<float> horizontal{1, -2, 0.5f, 3, 0.25f}, vertical{0.5f, 1, -4};
  const Image result = convolve(image, horizontal, vertical);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x)
      for (int c = 0; c < 2; ++c) {
        double sum = 0;
        for (int j = -1; j <= 1; ++j)
          for (int i = -2; i <= 2; ++i)
            sum += double(horizontal[size_t(i + 2)]) * vertical[size_t(j + 1)] *
                   image.pixel(std::clamp(x + i, 0, 6), std::clamp(y + j, 0, 4))[c];
        EXPECT_NEAR(result.pixel(x, y)[c], sum, 1e-4) << x << " " << y;
      }
}

TEST(Convolve, KernelLargerThanThePicture) {
  Image image(1, 1, 1);
  image.values = {2};
  const std::vector<float> box(9, 1.f / 9);
  EXPECT_FLOAT_EQ(convolve(image, box, box).values[0], 2);
  EXPECT_TRUE(convolve(Image(), box, box).empty());
}

TEST(Colormap, EndsAndMiddle) {
  Image map(6, 1, 1);
  map.values = {0, 1, 100.f / 255, 200.f / 255, 7, -1};
  const Image8 picture = colormap(map);
  const auto near = [&](int x, int r, int g, int b) {
    const uint8_t* p = picture.pixel(x, 0);
    EXPECT_NEAR(p[0], r, 3) << x;
    EXPECT_NEAR(p[1], g, 3) << x;
    EXPECT_NEAR(p[2], b, 3) << x;
  };
  near(0, 0, 0, 4);
  near(1, 252, 253, 191);
  near(2, 137, 40, 129);  // entries 100 and 200 of matplotlib's table
  near(3, 253, 152, 105);
  near(4, 252, 253, 191);
  near(5, 0, 0, 4);
}

TEST(Colormap, LightnessRises) {
  Image map(1000, 1, 1);
  for (int x = 0; x < 1000; ++x) map.values[size_t(x)] = float(x) / 999 * 3;
  const Image8 picture = colormap(map, 3);
  float last = -1;
  for (int x = 0; x < 1000; ++x) {
    const uint8_t* p = picture.pixel(x, 0);
    const auto linear = [](uint8_t v) { return srgb_to_linear(float(v) / 255); };
    const float y = luminance({linear(p[0]), linear(p[1]), linear(p[2])});
    EXPECT_GE(y, last - 0.004f) << x;
    last = y;
  }
}

TEST(Colormap, NotANumberStandsOut) {
  Image map(1, 1, 1);
  map.values = {NAN};
  EXPECT_EQ(colormap(map).values, (std::vector<uint8_t>{0, 255, 0}));
}

}  // namespace
}  // namespace vernier
