// SPDX-License-Identifier: Apache-2.0
#include "core/film/gradient_film.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/film/error_estimate.h"
#include "tests/support/random.h"

// What becomes of pixels and of the differences between them.

namespace vernier::test {
namespace {

/// The differences to the neighbors of a picture value(x, y), as one of the two sides tells them.
template <typename Value>
GradientFilm::Differences side_of(const Value& value, int x, int y) {
  GradientFilm::Differences differences;
  for (size_t k = 0; k < PixelNeighbors::count; ++k)
    differences[k] = (value(x + PixelNeighbors::dx[k], y + PixelNeighbors::dy[k]) - value(x, y)) * 0.5f;
  return differences;
}

// Where differences and pixels agree, the picture stays as it is, whatever samples pixels have; and what no
// difference tells of stays in its pixel.
TEST(GradientFilm, LeavesWhatFits) {
  const int width = 6, height = 5;
  const auto value = [](int x, int y) { return Rgb(1 + float(x * x), float(x + y), 0.5f * float(y)); };
  const Rgb primal_only(3, 2, 1);
  Film film(width, height);
  GradientFilm gradients(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int half = 0; half < Film::halves; ++half)
        for (int i = 0; i < 1 + (x + y + half) % 3; ++i) {
          const Rgb extra = x == 2 && y == 3 ? primal_only : Rgb(0, 0, 0);
          ASSERT_TRUE(film.add(x, y, half, value(x, y) + extra));
          gradients.add(x, y, half, extra, side_of(value, x, y));
        }
  gradients.reconstruct(film);
  ASSERT_TRUE(film.is_reconstructed());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int half = 0; half < Film::halves; ++half)
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(film.half_mean(x, y, half)[c], film.sample_mean(x, y, half)[c], 1e-4);
}

constexpr int side = 40;
double truth(int x, int y) { return 0.3 + 0.02 * x + 0.01 * y; }

/// Of noisy pixels and far less noisy differences.
Film reconstructed(uint64_t seed) {
  Random random(seed);
  const auto noise = [&](double size) { return float(size * (2 * double(random.next1()) - 1)); };
  const auto true_value = [](int x, int y) { return Rgb(float(truth(x, y))); };
  Film film(side, side);
  GradientFilm gradients(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int i = 0; i < 2 * 8; ++i) {
        EXPECT_TRUE(film.add(x, y, i % Film::halves, true_value(x, y) + Rgb(noise(0.25))));
        auto differences = side_of(true_value, x, y);
        for (Rgb& difference : differences) difference += Rgb(noise(0.05));
        gradients.add(x, y, i % Film::halves, {0, 0, 0}, differences);
      }
  gradients.reconstruct(film);
  return film;
}

// Neighbors err together after a reconstruction. The error that is told is still the true one, and its
// interval still holds it: with pixels taken for independent of each other it does in 64 % of the pictures.
TEST(GradientFilm, ErrorIsTheTrueOne) {
  constexpr int runs = 200;
  double estimated = 0, actual = 0;
  int held = 0;
  for (uint64_t seed = 1; seed <= runs; ++seed) {
    const Film film = reconstructed(seed);
    double error = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        error += square(film.pixel(x, y).x - truth(x, y)) / (square(truth(x, y)) + 0.01) / (side * side);
    const ErrorEstimate estimate = estimate_error(film);
    estimated += square(estimate.rel_rmse);
    actual += error;
    held += square(estimate.low) <= error && error <= square(estimate.high);
  }
  EXPECT_NEAR(estimated / actual, 1, 0.03);
  EXPECT_GE(held, 0.9 * runs);  // of 95 % by 25 groups of pixels; 0.93 is usual with so few
}

}  // namespace
}  // namespace vernier::test
