// SPDX-License-Identifier: Apache-2.0
#include "vernier/texture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vernier::test {
namespace {

std::shared_ptr<const Image8> image(int width, int height, int channels, std::vector<uint8_t> values) {
  auto picture = std::make_shared<Image8>(width, height, channels);
  picture->values = std::move(values);
  return picture;
}

Texture texture(std::shared_ptr<const Image8> picture, WrapMode wrap,
                FilterMode filter = FilterMode::linear) {
  return {std::move(picture), wrap, wrap, filter};
}

void expect_near(const Vec4f& actual, const Vec4f& expected, float tolerance = 1e-6f) {
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << "channel " << c;
}

TEST(Texture, ReadsTexelCentresExactly) {
  const auto picture =
      image(4, 2, 3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61});
  for (const FilterMode filter : {FilterMode::nearest, FilterMode::linear})
    for (const WrapMode wrap : {WrapMode::repeat, WrapMode::mirrored_repeat, WrapMode::clamp_to_edge})
      for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x) {
          const Vec2f uv((float(x) + 0.5f) / 4, (float(y) + 0.5f) / 2);
          const uint8_t* texel = picture->pixel(x, y);
          expect_near(texture(picture, wrap, filter).sample(uv, TexelEncoding::linear),
                      Vec4f(texel[0], texel[1], texel[2], 255) / 255.f);
        }
}

TEST(Texture, FillsMissingChannels) {
  const Vec2f centre(0.5f, 0.5f);
  const auto read = [&](int channels, std::vector<uint8_t> values) {
    return texture(image(1, 1, channels, std::move(values)), WrapMode::repeat)
        .sample(centre, TexelEncoding::linear);
  };
  expect_near(read(1, {51}), Vec4f(.2f, .2f, .2f, 1));
  expect_near(read(2, {51, 102}), Vec4f(.2f, .2f, .2f, .4f));
  expect_near(read(3, {51, 102, 153}), Vec4f(.2f, .4f, .6f, 1));
  expect_near(read(4, {51, 102, 153, 204}), Vec4f(.2f, .4f, .6f, .8f));
}

TEST(Texture, ReproducesRamps) {
  std::vector<uint8_t> values;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) values.push_back(uint8_t(10 * x + 20 * y));
  const Texture ramp = texture(image(8, 8, 1, values), WrapMode::clamp_to_edge);
  for (const Vec2f& texel : {Vec2f(0.5f, 0.5f), Vec2f(3.2f, 4.9f), Vec2f(7.1f, 0.8f), Vec2f(6.5f, 6.5f)})
    EXPECT_NEAR(ramp.sample(texel / 8.f, TexelEncoding::linear).x,
                (10 * (texel.x - 0.5f) + 20 * (texel.y - 0.5f)) / 255, 1e-5);
}

TEST(Texture, DecodesBeforeFilteringButNotAlpha) {
  const Texture t = texture(image(2, 1, 4, {0, 0, 0, 0, 255, 188, 255, 255}), WrapMode::clamp_to_edge);
  const Vec4f middle = t.sample({0.5f, 0.5f}, TexelEncoding::srgb);
  expect_near(middle, Vec4f(.5f, srgb_to_linear(188 / 255.f) / 2, .5f, .5f));
  for (int code = 0; code < 256; ++code) {
    const Texture one = texture(image(1, 1, 1, {uint8_t(code)}), WrapMode::repeat);
    EXPECT_EQ(one.sample({0, 0}, TexelEncoding::srgb).x, srgb_to_linear(float(code) / 255));
  }
}

TEST(Texture, DecodesSixteenBits) {
  const auto read = [](int channels, std::vector<uint16_t> codes, TexelEncoding encoding) {
    auto picture = std::make_shared<Image16>(1, 1, channels);
    picture->values = std::move(codes);
    return Texture(std::shared_ptr<const Image16>(picture), WrapMode::repeat, WrapMode::repeat,
                   FilterMode::linear)
        .sample({0.5f, 0.5f}, encoding);
  };
  const auto value = [](int code) { return float(code) / 65535; };
  const auto light = [&](int code) { return srgb_to_linear(value(code)); };
  constexpr auto linear = TexelEncoding::linear, srgb = TexelEncoding::srgb;
  expect_near(read(1, {300}, linear), Vec4f(value(300), value(300), value(300), 1));
  expect_near(read(2, {300, 65535}, srgb), Vec4f(light(300), light(300), light(300), 1));
  expect_near(read(3, {1, 2000, 65535}, srgb), Vec4f(light(1), light(2000), 1, 1), 1e-9f);
  expect_near(read(4, {1, 2, 3, 4}, linear), Vec4f(value(1), value(2), value(3), value(4)), 1e-9f);
  expect_near(read(4, {900, 40000, 3, 500}, srgb), Vec4f(light(900), light(40000), light(3), value(500)));
}

/// A gradient over one step of eight bits: they would show it as one or two bands.
TEST(Texture, ShowsGradientsFinerThanEightBits) {
  auto picture = std::make_shared<Image16>(256, 1, 1);
  for (size_t x = 0; x < 256; ++x) picture->values[x] = uint16_t(0x4000 + x);
  const Texture texture(std::shared_ptr<const Image16>(picture), WrapMode::clamp_to_edge,
                        WrapMode::clamp_to_edge, FilterMode::linear);
  for (const TexelEncoding encoding : {TexelEncoding::linear, TexelEncoding::srgb}) {
    float last = 0;
    for (int i = 0; i < 1000; ++i) {
      const float u = (0.5f + 255 * float(i) / 1000) / 256;
      const float value = texture.sample({u, 0.5f}, encoding).x, ideal = (0x4000 + 256 * u - 0.5f) / 65535;
      EXPECT_GT(value, last);
      EXPECT_NEAR(value, encoding == TexelEncoding::srgb ? srgb_to_linear(ideal) : ideal, 1e-7);
      last = value;
    }
  }
}

/// Values along one row of three texels, 0, 100 and 200, at texel positions.
float row(WrapMode wrap, FilterMode filter, float position) {
  return texture(image(3, 1, 1, {0, 100, 200}), wrap, filter)
             .sample({position / 3, 0.5f}, TexelEncoding::linear)
             .x *
         255;
}

TEST(Texture, Repeats) {
  constexpr auto wrap = WrapMode::repeat;
  EXPECT_NEAR(row(wrap, FilterMode::linear, 0), 100, 1e-3) << "between the last texel and the first";
  EXPECT_NEAR(row(wrap, FilterMode::linear, 3), 100, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::linear, -0.5f), 200, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::linear, 4.5f), 100, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::nearest, -0.1f), 200, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::nearest, 3.1f), 0, 1e-3);
}

TEST(Texture, Mirrors) {
  constexpr auto wrap = WrapMode::mirrored_repeat;
  EXPECT_NEAR(row(wrap, FilterMode::linear, -0.5f), 0, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::linear, -1.5f), 100, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::linear, 3.5f), 200, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::linear, 5), 50, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::linear, 3), 200, 1e-3) << "no seam";
  EXPECT_NEAR(row(wrap, FilterMode::nearest, 4.2f), 100, 1e-3);
}

TEST(Texture, Clamps) {
  constexpr auto wrap = WrapMode::clamp_to_edge;
  EXPECT_NEAR(row(wrap, FilterMode::linear, -9), 0, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::linear, 0.2f), 0, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::linear, 99), 200, 1e-3);
  EXPECT_NEAR(row(wrap, FilterMode::nearest, 3), 200, 1e-3);
}

TEST(Texture, ReadsSomethingAtEveryCoordinate) {
  const float coordinates[] = {-0.f,   1,           -1e-9f, 1e7f,     -1e7f,     3e38f,
                               -3e38f, 0.99999994f, 1e-40f, INFINITY, -INFINITY, std::nanf("")};
  const auto picture = image(3, 5, 3, std::vector<uint8_t>(45, 255));
  for (const FilterMode filter : {FilterMode::nearest, FilterMode::linear})
    for (const WrapMode wrap : {WrapMode::repeat, WrapMode::mirrored_repeat, WrapMode::clamp_to_edge})
      for (const float u : coordinates)
        for (const float v : coordinates)
          expect_near(texture(picture, wrap, filter).sample({u, v}, TexelEncoding::linear),
                      Vec4f(1, 1, 1, 1));
}

TEST(Texture, ReadsCoordinatesThatAreNotFiniteAsZero) {
  const Texture t = texture(image(2, 2, 1, {10, 20, 30, 40}), WrapMode::repeat, FilterMode::nearest);
  EXPECT_EQ(t.sample({std::nanf(""), 0.75f}, TexelEncoding::linear).x, 30 / 255.f);
  EXPECT_EQ(t.sample({0.75f, INFINITY}, TexelEncoding::linear).x, 20 / 255.f);
}

}  // namespace
}  // namespace vernier::test
