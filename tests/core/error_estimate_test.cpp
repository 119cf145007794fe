#include "core/image/error_estimate.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/random.h"

namespace vernier {
namespace {

constexpr int side = 32;

/// What infinitely many samples of paint() would give.
double truth(int x, int y) { return 0.05 + 0.02 * x + 0.01 * y; }

/// `count` independent samples a half and pixel, spread evenly from half to three halves of the truth.
Film paint(uint64_t seed, int count) {
  test::Random random(seed);
  Film film(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int i = 0; i < count * Film::halves; ++i) {
        const auto value = float(truth(x, y) * (0.5 + random.next1()));
        EXPECT_TRUE(film.add(x, y, i % Film::halves, {value, value, value}));
      }
  return film;
}

double squared_relative_error(double value, double expected) {
  return square(value - expected) / (square(expected) + 0.01);
}

template <typename Truth>
double true_squared_error(const Film& film, const Truth& expected) {
  double sum = 0;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) sum += squared_relative_error(film.pixel(x, y).x, expected(x, y));
  return sum / (double(film.width()) * film.height());
}

// The reported interval is that of 95 %; of a calm image it widens in proportion to normal quantiles.
TEST(ErrorEstimate, IntervalsHoldTheTruthAsOftenAsTheySay) {
  constexpr int runs = 400;
  constexpr std::array<std::array<double, 2>, 4> nominal{
      {{0.5, 0.6745}, {0.9, 1.645}, {0.95, 1.96}, {0.99, 2.576}}};
  std::array<int, nominal.size()> held{};
  double estimated = 0, actual = 0;
  for (uint64_t seed = 1; seed <= runs; ++seed) {
    const Film film = paint(seed, 8);
    const ErrorEstimate estimate = estimate_error(film);
    const double middle = square(estimate.rel_rmse), margin = square(estimate.high) - middle;
    const double error = true_squared_error(film, truth);
    estimated += middle;
    actual += error;
    for (size_t i = 0; i < nominal.size(); ++i)
      held[i] += std::abs(error - middle) <= margin * nominal[i][1] / 1.96;
    EXPECT_LT(estimate.unreliable, 0.005);
  }
  EXPECT_NEAR(estimated / actual, 1, 0.02);
  for (size_t i = 0; i < nominal.size(); ++i) {
    const double part = nominal[i][0];
    const double deviation = std::sqrt(part * (1 - part) / runs);
    EXPECT_NEAR(double(held[i]) / runs, part, 3.5 * deviation + 0.01) << part;
  }
}

TEST(ErrorEstimate, PixelIntervalsOfCalmPixelsHoldTheTruth) {
  size_t held = 0, values = 0;
  double predicted = 0, actual = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const Film film = paint(seed, 32);
    const ErrorLayers layers = error_layers(film);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const double error = film.pixel(x, y).x - truth(x, y);
        const double deviation = layers.standard_error.pixel(x, y)[0];
        held += std::abs(error) <= 1.96 * deviation;
        predicted += square(deviation);
        actual += square(error);
        ++values;
      }
  }
  EXPECT_NEAR(double(held) / double(values), 0.95, 0.01);
  EXPECT_NEAR(predicted / actual, 1, 0.03);
}

// A firefly's error relative to itself is one, and relative to the truth it is hundreds.
TEST(ErrorEstimate, FireflyIsFlaggedAndInTheInterval) {
  Film film = paint(1, 32);
  const int x = 9, y = 20;
  ASSERT_TRUE(film.add(x, y, 0, {500, 500, 500}));
  // Found once in 65 samples where one in 5,000 is such.
  const auto with_firefly = [&](int i, int j) { return truth(i, j) + (i == x && j == y ? 500.0 / 5000 : 0); };
  const double error = std::sqrt(true_squared_error(film, with_firefly));
  const ErrorEstimate estimate = estimate_error(film);
  EXPECT_LT(estimate.low, error);
  EXPECT_GT(estimate.high, error);
  EXPECT_GT(estimate.rel_rmse, 0.25 * error);
  const ErrorLayers layers = error_layers(film);
  EXPECT_EQ(*layers.unreliable.pixel(x, y), 1);
  // One such pixel says nothing against its neighbours.
  EXPECT_LT(estimate.unreliable, 0.01);
}

TEST(ErrorEstimate, ManyFirefliesMakeTheirNeighbourhoodSuspect) {
  Film film = paint(1, 32);
  for (int i = 0; i < side; i += 2)
    for (int j = 0; j < side; j += 2) ASSERT_TRUE(film.add(i, j, 0, {500, 500, 500}));
  EXPECT_EQ(estimate_error(film).unreliable, 1);
}

TEST(ErrorEstimate, IsNotKnownWhileAPixelLacksSamples) {
  Film film(2, 1);
  for (int i = 0; i < 16; ++i) ASSERT_TRUE(film.add(0, 0, i % 2, {1, 1, 1}));
  const ErrorEstimate estimate = estimate_error(film);
  EXPECT_TRUE(std::isnan(estimate.rel_rmse));
  EXPECT_GE(estimate.unreliable, 0.5);
}

}  // namespace
}  // namespace vernier
