// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "integrators/render/render.h"
#include "tests/support/test_scenes.h"

// Small pictures that are rendered many times, and compared pixel by pixel.

namespace vernier::test {

/// Looks from `from` to `to`, which is not straight above or below.
CameraDescription camera_at(const Vec3f& from, const Vec3f& to, float yfov);

/// What of a scene is rendered, and how.
struct PictureCase {
  const Scene& scene;
  CameraDescription camera;
  RenderSettings settings;  ///< the camera and the seed of it do not count
};

/// By row, column and channel, then the means of these over the picture: the values that renders of
/// different seeds find.
std::vector<Samples> pixels_of(const PictureCase& picture, int renders, uint64_t first_seed);

/// Smallest p-value of Welch's tests that each of the values is the same, times how many there are.
double difference(const std::vector<Samples>& a, const std::vector<Samples>& b);

/// Relative bias of the picture's mean that would be found nine times in ten.
double resolution(const std::vector<Samples>& a, const std::vector<Samples>& b, double significance);

}  // namespace vernier::test
