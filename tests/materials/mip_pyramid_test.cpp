// SPDX-License-Identifier: Apache-2.0
#include "materials/mip_pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/random.h"

namespace vernier::test {
namespace {

/// Sixteen bits, so that what is measured is not their rounding.
std::shared_ptr<const Image16> picture(int width, int height, int channels,
                                       const std::function<float(int x, int y, int c)>& light) {
  auto image = std::make_shared<Image16>(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) {
        const bool is_alpha = channels % 2 == 0 && c == channels - 1;
        const float value = light(x, y, c);
        image->pixel(x, y)[c] = uint16_t(std::lround(65535 * (is_alpha ? value : linear_to_srgb(value))));
      }
  return image;
}

MipPyramid pyramid(const TexturePixels& pixels, WrapMode wrap, bool by_alpha = false) {
  return {{pixels, wrap, wrap, FilterMode::linear}, make_mips(pixels, by_alpha), by_alpha};
}

const Image16& image_of(const TexturePixels& pixels) {
  return *std::get<std::shared_ptr<const Image16>>(pixels);
}

double light_at(const Image16& image, int x, int y, int c) {
  return srgb_to_linear(float(image.pixel(x, y)[c]) / 65535);
}

/// How much of [i, i + 1) lies in [from, to).
double overlap(int i, double from, double to) {
  return std::max(0.0, std::min(i + 1.0, to) - std::max(double(i), from));
}

/// Each texel of each copy against the integral over its box of the copy before.
TEST(MipPyramid, TexelsAreMeansOfTheirBoxes) {
  for (const auto& [width, height] : {std::pair(8, 4), {5, 3}, {7, 1}, {1, 6}, {13, 8}, {3, 9}}) {
    Random random(7);
    const TexturePixels base = picture(width, height, 3, [&](int, int, int) { return random.next1(); });
    auto mips = make_mips(base, false);
    ASSERT_FALSE(mips.empty());
    EXPECT_EQ(image_of(mips.back()).values.size(), 3u);
    mips.insert(mips.begin(), base);
    for (size_t level = 1; level < mips.size(); ++level) {
      const Image16 &large = image_of(mips[level - 1]), &small = image_of(mips[level]);
      EXPECT_EQ(small.width, std::max(1, large.width / 2));
      EXPECT_EQ(small.height, std::max(1, large.height / 2));
      const double across = double(large.width) / small.width, down = double(large.height) / small.height;
      for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x)
          for (int c = 0; c < 3; ++c) {
            double sum = 0;
            for (int j = 0; j < large.height; ++j)
              for (int i = 0; i < large.width; ++i)
                sum += light_at(large, i, j, c) * overlap(i, x * across, (x + 1) * across) *
                       overlap(j, y * down, (y + 1) * down);
            EXPECT_NEAR(light_at(small, x, y, c), sum / (across * down), 3e-5)
                << width << "x" << height << " level " << level;
          }
    }
  }
}

TEST(MipPyramid, KeepsEveryCodeOfEightBits) {
  for (int code = 0; code < 256; ++code) {
    auto image = std::make_shared<Image8>(6, 5, 1);
    std::fill(image->values.begin(), image->values.end(), uint8_t(code));
    for (const TexturePixels& mip : make_mips(std::shared_ptr<const Image8>(image), false))
      for (const uint8_t value : std::get<std::shared_ptr<const Image8>>(mip)->values) EXPECT_EQ(value, code);
  }
}

/// Light is what is averaged: half of black and white is 188 and not 128.
TEST(MipPyramid, AveragesLight) {
  auto image = std::make_shared<Image8>(2, 2, 1);
  image->values = {0, 255, 255, 0};
  const auto mips = make_mips(std::shared_ptr<const Image8>(image), false);
  ASSERT_EQ(mips.size(), 1u);
  EXPECT_EQ(std::get<std::shared_ptr<const Image8>>(mips[0])->values[0], 188);
}

TEST(MipPyramid, TexelsWithoutCoverageHaveNoColor) {
  // Green that covers, red that does not, and a quarter of blue.
  const float alphas[] = {1, 0, 0.5f, 0.5f};
  const TexturePixels base = picture(4, 1, 4, [&](int x, int, int c) {
    if (c == 3) return alphas[x];
    return c == (x == 0 ? 1 : x == 1 ? 0 : 2) ? 1.f : 0.f;
  });
  const auto mips = make_mips(base, true);
  const Image16& half = image_of(mips[0]);
  ASSERT_EQ(half.channels, 4);
  EXPECT_NEAR(light_at(half, 0, 0, 0), 0, 1e-6);
  EXPECT_NEAR(light_at(half, 0, 0, 1), 1, 1e-6);
  EXPECT_NEAR(half.pixel(0, 0)[3] / 65535.0, 0.5, 1e-5);
  const Image16& all = image_of(mips[1]);
  EXPECT_NEAR(light_at(all, 0, 0, 1), 0.5, 3e-5);
  EXPECT_NEAR(light_at(all, 0, 0, 2), 0.5, 3e-5);
  EXPECT_EQ(image_of(make_mips(base, false)[0]).channels, 3);
  EXPECT_NEAR(light_at(image_of(make_mips(base, false)[0]), 0, 0, 0), 0.5, 3e-5);
}

/// Second moments of where light comes from, texels^2.
struct Moments {
  double xx = 0, xy = 0, yy = 0;
};

/// Of a single bright texel's light, wherever it lies among the copies' texels.
Moments spread_of(const UvArea& texels) {
  constexpr int size = 64, phases = 8;
  constexpr double step = 0.5;
  Moments total;
  double light = 0;
  for (int py = 0; py < phases; ++py)
    for (int px = 0; px < phases; ++px) {
      const int x0 = size / 2 + px, y0 = size / 2 + py;
      const MipPyramid mips =
          pyramid(picture(size, size, 1, [&](int x, int y, int) { return x == x0 && y == y0 ? 1.f : 0.f; }),
                  WrapMode::repeat);
      for (double y = step / 2; y < size; y += step)
        for (double x = step / 2; x < size; x += step) {
          const float value = mips.sample({float(x) / size, float(y) / size},
                                          {texels[0] / float(size), texels[1] / float(size)})
                                  .x;
          const double dx = x - (x0 + 0.5), dy = y - (y0 + 0.5);
          total.xx += value * dx * dx;
          total.xy += value * dx * dy;
          total.yy += value * dy * dy;
          light += value;
        }
    }
  return {total.xx / light, total.xy / light, total.yy / light};
}

/// What is read has the variance of the area's box beside that of interpolation, whatever its size, shape and
/// direction.
TEST(MipPyramid, SpreadsLightAsTheAreaDoes) {
  const Moments point = spread_of({Vec2f(0, 0), Vec2f(0, 0)});
  for (const auto& [length, width, degrees] : {std::tuple(1.f, 1.f, 0.f),
                                               {2.5f, 2.5f, 0.f},
                                               {4.f, 4.f, 20.f},
                                               {6.f, 1.5f, 0.f},
                                               {7.f, 2.f, 35.f},
                                               {9.f, 1.f, 90.f}}) {
    const float angle = degrees * std::numbers::pi_v<float> / 180;
    const Vec2f p = Vec2f(std::cos(angle), std::sin(angle)) * length,
                q = Vec2f(-std::sin(angle), std::cos(angle)) * width;
    const Moments found = spread_of({p, q});
    const double scale = (length * length + width * width) / 12;
    EXPECT_NEAR((found.xx - point.xx) / scale, (p.x * p.x + q.x * q.x) / 12 / scale, 0.03) << length;
    EXPECT_NEAR((found.yy - point.yy) / scale, (p.y * p.y + q.y * q.y) / 12 / scale, 0.03) << length;
    EXPECT_NEAR((found.xy - point.xy) / scale, (p.x * p.y + q.x * q.y) / 12 / scale, 0.03) << length;
  }
}

TEST(MipPyramid, LeavesRampsAsTheyAre) {
  const MipPyramid mips =
      pyramid(picture(128, 128, 1, [](int x, int y, int) { return float(x + y + 1) / 256; }),
              WrapMode::clamp_to_edge);
  for (const float side : {0.f, 0.3f, 1.f, 3.f, 7.f, 12.f})
    for (const float longer : {1.f, 2.5f, 5.f})
      for (const Vec2f& at : {Vec2f(60.2f, 64.9f), Vec2f(64, 64), Vec2f(71.7f, 58.1f)})
        EXPECT_NEAR(
            mips.sample(at / 128.f, {Vec2f(side * longer / 128, 0), Vec2f(0.2f * side / 128, side / 128)}).x,
            (at.x + at.y) / 256, 2e-4)
            << side << " " << longer;
}

TEST(MipPyramid, WrapsAtEverySize) {
  const TexturePixels steps = picture(32, 32, 1, [](int x, int, int) { return x < 16 ? 0.f : 1.f; });
  const float edge = 1e-4f;
  for (const float side : {2.f, 4.f, 8.f}) {
    const UvArea area{Vec2f(side / 32, 0), Vec2f(0, side / 32)};
    EXPECT_NEAR(pyramid(steps, WrapMode::repeat).sample({edge, 0.5f}, area).x, 0.5f, 0.01f);
    EXPECT_NEAR(pyramid(steps, WrapMode::clamp_to_edge).sample({edge, 0.5f}, area).x, 0, 1e-6f);
    EXPECT_NEAR(pyramid(steps, WrapMode::mirrored_repeat).sample({1 + edge, 0.5f}, area).x, 1, 1e-6f);
  }
}

TEST(MipPyramid, ReadsPointsAsTexturesAre) {
  const TexturePixels noise =
      picture(9, 7, 3, [](int x, int y, int c) { return float((x * 31 + y * 17 + c * 7) % 23) / 22; });
  const Texture texture(noise, WrapMode::repeat, WrapMode::repeat, FilterMode::nearest);
  const MipPyramid mips(texture, make_mips(noise, false), false);
  const float nan = std::nanf("");
  for (const float u : {0.1f, 0.77f, -3.2f, nan})
    for (const UvArea& area : {UvArea{Vec2f(0, 0), Vec2f(0, 0)},
                               {Vec2f(1e-4f, 0), Vec2f(0, 1e-3f)},
                               {Vec2f(nan, 0), Vec2f(0, 1)}}) {
      const Vec4f texel = texture.sample({u, 0.4f}, TexelEncoding::srgb);
      EXPECT_EQ(mips.sample({u, 0.4f}, area), Rgb(texel.x, texel.y, texel.z));
    }
}

TEST(MipPyramid, IsTheMeanAtAnySizeBeyondItsOwn) {
  const TexturePixels checker = picture(16, 16, 1, [](int x, int y, int) { return float((x + y) % 2); });
  const MipPyramid mips = pyramid(checker, WrapMode::repeat);
  for (const float side : {4.f, 60.f, 1e10f, 1e30f, INFINITY})
    EXPECT_NEAR(mips.sample({0.3f, 0.9f}, {Vec2f(side, 0), Vec2f(0, side)}).x, 0.5, 2e-5) << side;
  EXPECT_NEAR(mips.sample({0.3f, 0.9f}, {Vec2f(1e20f, 1e20f), Vec2f(0, 1e-20f)}).x, 0.5, 2e-5);
}

}  // namespace
}  // namespace vernier::test
