// SPDX-License-Identifier: Apache-2.0
#include "core/film/error_estimate.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "tests/support/random.h"

namespace vernier {
namespace {

constexpr int side = 32;

/// One sample of a pixel: number `i` of the `count` of its half.
using Sample = std::function<double(int x, int y, int i, int count, test::Random&)>;
using Truth = std::function<double(int x, int y)>;

/// A picture whose truth is known.
struct Picture {
  Truth truth;
  Sample sample;

  Film paint(uint64_t seed, int count) const {
    test::Random random(seed);
    Film film(side, side);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        for (int i = 0; i < count * Film::halves; ++i) {
          const auto value = float(sample(x, y, i / Film::halves, count, random));
          EXPECT_TRUE(film.add(x, y, i % Film::halves, {value, value, value}));
        }
    return film;
  }

  double squared_error(const Film& film) const {
    double sum = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        sum += square(film.pixel(x, y).x - truth(x, y)) / (square(truth(x, y)) + 0.01);
    return sum / (side * side);
  }
};

double slope(int x, int y) { return 0.05 + 0.02 * x + 0.01 * y; }

/// Evenly spread from half to three halves of the truth.
const Picture calm{
    slope, [](int x, int y, int, int, test::Random& random) { return slope(x, y) * (0.5 + random.next1()); }};

/// Textured, with tails: two squares brighter than the others by the factor 8, as a chessboard's.
Picture lognormal(double sigma) {
  const Truth truth = [](int x, int y) { return (x / 4 + y / 4) % 2 == 0 ? 0.1 : 0.8; };
  return {truth, [=](int x, int y, int, int, test::Random& random) {
            const double radius = std::sqrt(-2 * std::log(1 - double(random.next1())));
            const double normal = radius * std::cos(2 * double(pi) * random.next1());
            return truth(x, y) * std::exp(sigma * normal - sigma * sigma / 2);
          }};
}

/// As `calm`, but every pixel has a chance of `chance` a sample for one that is `value`.
Picture fireflies(double chance, double value) {
  return {[=](int x, int y) { return (1 - chance) * slope(x, y) + chance * value; },
          [=](int x, int y, int i, int count, test::Random& random) {
            return random.next1() < chance ? value : calm.sample(x, y, i, count, random);
          }};
}

/// A lamp of radiance 20 whose edge runs through the pixels of column 16, half of which it covers: perfectly
/// stratified, but the spread of the samples does not show that. Around it, light as noisy as in `calm`.
const Picture lamp{
    [](int x, int y) { return x < 16 ? slope(x, y) : (x == 16 ? 20 * (0.5 + 0.25 / 32) : 20); },
    [](int x, int y, int i, int count, test::Random& random) {
      if (x < 16) return calm.sample(x, y, i, count, random);
      if (x > 16) return 20.0;
      return (i + double(random.next1())) / count < 0.5 + 0.25 / count ? 20.0 : 0.0;
    }};

/// The left half's samples are stratified, as evenly spread as those of the right half.
const Picture half_stratified{slope, [](int x, int y, int i, int count, test::Random& random) {
                                const double u = random.next1();
                                return slope(x, y) * (0.5 + (x < side / 2 ? (i + u) / count : u));
                              }};

/// Every other pixel's samples are stratified, and vary fifty times as much as those of the rest.
const Picture mixed{[](int, int) { return 1.0; },
                    [](int x, int y, int i, int count, test::Random& random) {
                      const double u = random.next1();
                      return (x + y) % 2 == 0 ? 0.5 + (i + u) / count : 0.99 + 0.02 * u;
                    }};

/// Sixteen brightnesses, so that only a dozen pixels are alike.
double scattered_truth(int x, int y) { return 0.2 * std::pow(1.7, (7 * x + 11 * y) % 16); }
const Picture scattered{scattered_truth, [](int x, int y, int, int, test::Random& random) {
                          return scattered_truth(x, y) * (0.5 + random.next1());
                        }};

constexpr std::array<std::array<double, 2>, 4> nominal{
    {{0.5, 0.6745}, {0.9, 1.645}, {0.95, 1.96}, {0.99, 2.576}}};

using Region = std::function<bool(int x, int y)>;
bool everywhere(int, int) { return true; }

/// How the error layer fares in pixels that are not flagged.
struct Calibration {
  std::array<double, nominal.size()> covered{};
  double predicted_over_actual = 0, flagged = 0, values = 0;
};

Calibration calibrate(const Picture& picture, int count, int runs, const Region& region = everywhere) {
  Calibration result;
  double predicted = 0, actual = 0, pixels = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    const Film film = picture.paint(uint64_t(seed), count);
    const ErrorLayers layers = error_layers(film);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        if (!region(x, y)) continue;
        ++pixels;
        if (*layers.unreliable.pixel(x, y) != 0) continue;
        ++result.values;
        const double error = film.pixel(x, y).x - picture.truth(x, y);
        const double deviation = layers.standard_error.pixel(x, y)[0];
        for (size_t i = 0; i < nominal.size(); ++i)
          result.covered[i] += std::abs(error) <= nominal[i][1] * deviation;
        predicted += square(deviation);
        actual += square(error);
      }
  }
  for (double& covered : result.covered) covered /= result.values;
  result.predicted_over_actual = std::sqrt(predicted / actual);
  result.flagged = 1 - result.values / pixels;
  return result;
}

/// `systematic`: what the coverage may be off besides chance, which is allowed for at 3.5 standard
/// deviations.
void expect_coverage(const Calibration& calibration, double systematic) {
  for (size_t i = 0; i < nominal.size(); ++i) {
    const double part = nominal[i][0];
    const double chance = std::sqrt(part * (1 - part) / calibration.values);
    EXPECT_NEAR(calibration.covered[i], part, 3.5 * chance + systematic) << part;
  }
}

// The reported interval is that of 95 %; it widens in proportion to normal quantiles of the logarithm.
TEST(ErrorEstimate, IntervalsHoldTheTruthAsOftenAsTheySay) {
  constexpr int runs = 400;
  std::array<int, nominal.size()> held{};
  double estimated = 0, actual = 0;
  for (uint64_t seed = 1; seed <= runs; ++seed) {
    const Film film = calm.paint(seed, 8);
    const ErrorEstimate estimate = estimate_error(film);
    const double middle = square(estimate.rel_rmse), margin = std::log(square(estimate.high) / middle);
    const double error = calm.squared_error(film);
    estimated += middle;
    actual += error;
    for (size_t i = 0; i < nominal.size(); ++i)
      held[i] += std::abs(std::log(error / middle)) <= margin * nominal[i][1] / 1.96;
    EXPECT_LT(estimate.unreliable, 0.005);
  }
  EXPECT_NEAR(estimated / actual, 1, 0.02);
  for (size_t i = 0; i < nominal.size(); ++i) {
    const double part = nominal[i][0];
    const double deviation = std::sqrt(part * (1 - part) / runs);
    EXPECT_NEAR(double(held[i]) / runs, part, 3.5 * deviation + 0.01) << part;
  }
}

// Where pixels are noisy, those that are too bright have the larger differences: relative to their own values
// these would come to too little.
TEST(ErrorEstimate, NoiseIsNotRelativeToItself) {
  constexpr int runs = 60;
  for (const Picture& picture : {lognormal(1), fireflies(0.2, 20), fireflies(0.05, 20)}) {
    double estimated = 0, actual = 0;
    int held = 0;
    for (uint64_t seed = 1; seed <= runs; ++seed) {
      const Film film = picture.paint(seed, 32);
      const ErrorEstimate estimate = estimate_error(film);
      const double error = picture.squared_error(film);
      estimated += square(estimate.rel_rmse);
      actual += error;
      held += estimate.low <= std::sqrt(error) && std::sqrt(error) <= estimate.high;
    }
    EXPECT_NEAR(std::sqrt(estimated / actual), 1, 0.05);
    EXPECT_GE(held, 50);  // of 57 expected; fewer than 51 once in a hundred
  }
}

TEST(ErrorLayers, IntervalsOfPixelsHoldTheTruth) {
  expect_coverage(calibrate(calm, 8, 20), 0.01);
  expect_coverage(calibrate(calm, 32, 20), 0.01);
  // A dozen squares know their mean to a third: Student's intervals, whose narrow ones hold a bit too much.
  const Calibration few = calibrate(scattered, 32, 20);
  expect_coverage(few, 0.02);
  EXPECT_NEAR(few.covered[2], 0.95, 0.01);
  // Means of so few samples with tails are not normal, and the pool is of different pixels.
  expect_coverage(calibrate(lognormal(1), 32, 20), 0.01);
  const Calibration rare = calibrate(fireflies(0.05, 20), 32, 20);
  expect_coverage(rare, 0.02);
  EXPECT_LT(rare.flagged, 0.01);
}

TEST(ErrorLayers, PredictTheError) {
  for (const Picture& picture : {calm, lognormal(1), fireflies(0.2, 20), fireflies(0.05, 20)})
    EXPECT_NEAR(calibrate(picture, 32, 20).predicted_over_actual, 1.01, 0.05);
}

// Half of the pixels have light that one sample in a hundred finds: what has missed it cannot know. Flags and
// pooling see to it that the pixels that are trusted do not lie.
TEST(ErrorLayers, RareLightIsFlaggedOrKnown) {
  const Calibration calibration = calibrate(fireflies(0.01, 20), 32, 20);
  EXPECT_GT(calibration.flagged, 0.3);
  EXPECT_GT(calibration.covered[2], 0.92);
}

// Stratification gains nothing for some pixels and much for others; what it gains is taken from pixels alike.
TEST(ErrorLayers, KnowWhatStratificationGains) {
  const auto left = [](int x, int) { return x < side / 4; };
  const auto right = [](int x, int) { return x >= side * 3 / 4; };
  EXPECT_NEAR(calibrate(half_stratified, 32, 20, left).predicted_over_actual, 1.01, 0.05);
  EXPECT_NEAR(calibrate(half_stratified, 32, 20, right).predicted_over_actual, 1.01, 0.05);
  const auto even = [](int x, int y) { return (x + y) % 2 == 0; };
  const auto odd = [](int x, int y) { return (x + y) % 2 != 0; };
  EXPECT_NEAR(calibrate(mixed, 32, 20, even).predicted_over_actual, 1.01, 0.05);
  EXPECT_NEAR(calibrate(mixed, 32, 20, odd).predicted_over_actual, 1.01, 0.05);
  const Calibration edge = calibrate(lamp, 32, 20, [](int x, int) { return x == 16; });
  EXPECT_NEAR(edge.predicted_over_actual, 1.03, 0.15);
  const Calibration beside = calibrate(lamp, 32, 20, [](int x, int) { return x == 15; });
  EXPECT_NEAR(beside.predicted_over_actual, 1.02, 0.1);
  const ErrorLayers layers = error_layers(lamp.paint(1, 32));
  EXPECT_LT(layers.standard_error.pixel(20, 16)[0], 1e-3) << "inside the lamp";
}

// A firefly's error relative to itself is one, and relative to the truth it is hundreds.
TEST(ErrorEstimate, FireflyIsFlaggedAndInTheInterval) {
  Film film = calm.paint(1, 32);
  const Film without = film;
  const int x = 9, y = 20;
  ASSERT_TRUE(film.add(x, y, 0, {500, 500, 500}));
  // Found once in 65 samples where one in 5,000 is such.
  const Picture rare{[=](int i, int j) { return slope(i, j) + (i == x && j == y ? 500.0 / 5000 : 0); }, {}};
  const double error = std::sqrt(rare.squared_error(film));
  const ErrorEstimate estimate = estimate_error(film);
  EXPECT_LT(estimate.low, error);
  EXPECT_GT(estimate.high, error);
  const ErrorLayers layers = error_layers(film), before = error_layers(without);
  EXPECT_EQ(*layers.unreliable.pixel(x, y), 1);
  // One such pixel says nothing against its neighbors.
  EXPECT_LT(estimate.unreliable, 0.01);
  for (const int apart : {1, 3})
    EXPECT_NEAR(layers.standard_error.pixel(x + apart, y)[0], before.standard_error.pixel(x + apart, y)[0],
                0.3 * before.standard_error.pixel(x + apart, y)[0]);
}

TEST(ErrorEstimate, ManyFirefliesMakeTheirNeighbourhoodSuspect) {
  Film film = calm.paint(1, 32);
  for (int i = 0; i < side; i += 2)
    for (int j = 0; j < side; j += 2) ASSERT_TRUE(film.add(i, j, 0, {500, 500, 500}));
  EXPECT_EQ(estimate_error(film).unreliable, 1);
}

// Squares of such differences are too small for a float.
TEST(ErrorLayers, LightFaintBeyondMeasureHasAnErrorToo) {
  Film film(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int i = 0; i < 32; ++i) ASSERT_TRUE(film.add(x, y, i % 2, {0, 0, x == 9 && i == 0 ? 1e-12f : 0}));
  for (const float error : error_layers(film).standard_error.values) {
    ASSERT_GE(error, 0);
    ASSERT_LT(error, 1e-12);
  }
}

TEST(ErrorEstimate, IsNotKnownWhileAPixelLacksSamples) {
  Film film(2, 1);
  for (int i = 0; i < 16; ++i) ASSERT_TRUE(film.add(0, 0, i % 2, {1, 1, 1}));
  const ErrorEstimate estimate = estimate_error(film);
  EXPECT_TRUE(std::isnan(estimate.rel_rmse));
  EXPECT_GE(estimate.unreliable, 0.5);
}

// Nine tenths of plain background make the figure of what stands before it no smaller.
TEST(ErrorEstimate, IsThatOfThePixelsThatShowASurface) {
  test::Random random(3);
  Film marked(side, side), unmarked(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int i = 0; i < 32; ++i) {
        const bool is_object = x < 10 && y < 10;
        const auto value = float(is_object ? calm.sample(x, y, i / 2, 16, random) : 0.7);
        ASSERT_TRUE(marked.add(x, y, i % 2, FilmSample{{value, value, value}, 0, is_object}));
        ASSERT_TRUE(unmarked.add(x, y, i % 2, {value, value, value}));
      }
  const ErrorEstimate object = estimate_error(marked), picture = estimate_error(unmarked);
  const double part = 100.0 / (side * side);
  EXPECT_NEAR(object.rel_rmse * std::sqrt(part), picture.rel_rmse, 1e-9);
  EXPECT_NEAR(object.unreliable * part, picture.unreliable, 0.01);
  EXPECT_LT(object.low, object.rel_rmse);
  EXPECT_GT(object.high, object.rel_rmse);
}

// Where nothing else is there to be seen, the background is what the picture is of.
TEST(ErrorEstimate, OfAPictureWithoutSurfacesIsThatOfAllPixels) {
  test::Random random(4);
  Film sky(side, side), wall(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int i = 0; i < 32; ++i) {
        const auto value = float(calm.sample(x, y, i / 2, 16, random));
        ASSERT_TRUE(sky.add(x, y, i % 2, FilmSample{{value, value, value}, 0, false}));
        ASSERT_TRUE(wall.add(x, y, i % 2, {value, value, value}));
      }
  EXPECT_EQ(estimate_error(sky).rel_rmse, estimate_error(wall).rel_rmse);
}

}  // namespace
}  // namespace vernier
