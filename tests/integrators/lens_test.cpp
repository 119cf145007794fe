// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "integrators/render/render.h"
#include "scene/camera.h"
#include "tests/support/test_scenes.h"

// Blur of a thin lens, against what geometry says of it.

namespace vernier::test {
namespace {

constexpr int size = 40;  // pixels of a square picture
constexpr double middle = size / 2.0;
constexpr float pixels_per_slope = 400;  // pixels for a unit of the plane at unit distance
constexpr float lens_radius = 0.1f;

CameraDescription view(float focus_distance) {
  CameraDescription camera;
  camera.yfov = 2 * std::atan(size / pixels_per_slope / 2);
  camera.lens_radius = lens_radius;
  camera.focus_distance = focus_distance;
  return camera;
}

Image picture(const Scene& scene, const CameraDescription& view, int spp) {
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.limits.spp = spp;
  settings.adaptive = false;
  const Camera camera(view, size, size);
  const std::atomic<bool> stop = false;
  return render(scene, camera, *path({}), settings, stop).film.image();
}

/// A square facing the camera, in the middle of the picture, that comes out `pixels` wide.
Scene square_light(float distance, float pixels) {
  const float side = pixels / pixels_per_slope * distance;
  return SceneBuilder()
      .add(parallelogram({-side / 2, -side / 2, -distance}, {side, 0, 0}, {0, side, 0}), emitter(1))
      .build();
}

/// Of the light in a picture, in pixels about its middle.
struct Blur {
  double sum = 0, mean_square = 0, farthest = 0;
};

Blur blur_of(const Image& image) {
  Blur blur;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double value = *image.pixel(x, y);
      const double squared = square(x + 0.5 - middle) + square(y + 0.5 - middle);
      blur.sum += value;
      blur.mean_square += value * squared;
      if (value > 0) blur.farthest = std::max(blur.farthest, std::sqrt(squared));
    }
  blur.mean_square /= blur.sum;
  return blur;
}

// A point at distance z comes out as a disk of radius a |1/z - 1/focus| on the plane at unit distance, for a
// lens of radius a. A small square comes out as that disk, convolved with the square and with the pixel's.
TEST(Lens, APointIsBlurredToTheCircleOfConfusion) {
  constexpr float light = 5;
  for (const auto& [distance, focus] :
       {std::pair(4.f, 2.f), {1.f, 4 / 3.f}, {4.f, std::numeric_limits<float>::infinity()}}) {
    const Blur blur = blur_of(picture(square_light(distance, light), view(focus), 256));
    const double radius = double(lens_radius) * std::abs(1 / distance - 1 / focus) * pixels_per_slope;
    ASSERT_GT(radius, 2 * light / 2);
    EXPECT_NEAR(blur.sum / square(light), 1, 0.04) << "all of the light is there";
    EXPECT_NEAR(blur.mean_square / (square(radius) / 2 + (square(light) + 1) / 6), 1, 0.03) << distance;
    EXPECT_LT(blur.farthest, radius + (light + 1) * std::sqrt(0.5));
    EXPECT_GT(blur.farthest, radius);
  }
}

TEST(Lens, WhatIsInFocusIsAsSharpAsAPinholesPicture) {
  constexpr int light = 10;
  const Scene scene = square_light(2, light);
  const Image sharp = picture(scene, view(2), 64);
  // Its edges are between pixels.
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const bool inside = std::max(std::abs(x + 0.5 - middle), std::abs(y + 0.5 - middle)) < light / 2.0;
      EXPECT_NEAR(*sharp.pixel(x, y), inside ? 1 : 0, 1.0 / 64) << x << " " << y;
    }
}

}  // namespace
}  // namespace vernier::test
