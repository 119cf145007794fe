// SPDX-License-Identifier: Apache-2.0
#include "core/denoise/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/parallel.h"
#include "core/compare/metrics.h"
#include "tests/support/random.h"
#include "vernier/error.h"

namespace vernier {

// GoogleTest would print bytes.
static void PrintTo(const Denoiser& denoiser, std::ostream* out) { *out << denoiser.name; }

namespace {

constexpr int size = 72;

Image constant(int width, int height, const Rgb& value) {
  Image image(width, height, 3);
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = value[int(i % 3)];
  return image;
}

// A striped floor and a wall that faces elsewhere, lit from one side.
struct TestScene {
  Image truth{size, size, 3}, albedo{size, size, 3}, normal{size, size, 3};
  TestScene() {
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const bool wall = y < size / 2;
        const float light = (wall ? 0.3f : 1.f) * (0.5f + float(x) / size);
        for (int c = 0; c < 3; ++c) {
          albedo.pixel(x, y)[c] = !wall && x / 4 % 2 == 0 ? 0.2f : 0.7f - 0.1f * float(c);
          truth.pixel(x, y)[c] = light * albedo.pixel(x, y)[c];
          normal.pixel(x, y)[c] = c == (wall ? 2 : 1) ? 1.f : 0.f;
        }
      }
  }
};

// Relative noise of 0.3 a value, and layers that say so.
NoisyImage noisy_view(const TestScene& scene, uint64_t seed) {
  NoisyImage noisy{scene.truth, scene.truth, scene.albedo, scene.normal};
  std::mt19937_64 engine(seed);
  std::normal_distribution<float> normal;
  for (size_t i = 0; i < noisy.color.values.size(); ++i) {
    noisy.color.values[i] *= std::max(0.f, 1 + 0.3f * normal(engine));
    noisy.error->values[i] *= 0.3f;
  }
  return noisy;
}

class EveryDenoiser : public testing::TestWithParam<Denoiser> {
 protected:
  Image filter(const NoisyImage& noisy) const { return GetParam().filter(noisy); }
};

/// What is not known of a network (core/image/denoise.h).
class EveryDenoiserNotLearned : public EveryDenoiser {};

std::vector<Denoiser> not_learned() {
  std::vector<Denoiser> found;
  std::copy_if(denoisers().begin(), denoisers().end(), std::back_inserter(found),
               [](const Denoiser& denoiser) { return !denoiser.learned; });
  return found;
}

TEST_P(EveryDenoiserNotLearned, ConstantPictureStaysAsItIs) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 3}}) {
    const Image image = constant(width, height, {1, 2, 3});
    EXPECT_EQ(filter({image}).values, image.values);
  }
  for (const float scale : {1e-4f, 1.f, 1e5f}) {
    const Image image = constant(40, 30, {0.3f * scale, scale, 0.1f * scale});
    for (const float error : {0.f, 0.2f * scale}) {
      const Image result = filter({image, constant(40, 30, {error, error, error})});
      for (size_t i = 0; i < image.values.size(); ++i)
        ASSERT_NEAR(result.values[i] / image.values[i], 1, 1e-6);
    }
    EXPECT_EQ(filter({image}).values, image.values);
  }
}

TEST_P(EveryDenoiser, HalvesTheErrorOfANoisyView) {
  const TestScene scene;
  const NoisyImage noisy = noisy_view(scene, 1);
  const double before = difference(noisy.color, scene.truth).rel_mse;
  EXPECT_LT(difference(filter(noisy), scene.truth).rel_mse, before / 4);
  EXPECT_LT(difference(filter({noisy.color, noisy.error, noisy.albedo}), scene.truth).rel_mse, before / 4);
}

// Stripes that differ in albedo alone: dividing by it, the light is the same on both, so no edge is left.
TEST_P(EveryDenoiserNotLearned, TextureIsKeptByAlbedo) {
  const TestScene scene;
  const Image sure =
      filter({scene.truth, constant(size, size, {0.1f, 0.1f, 0.1f}), scene.albedo, scene.normal});
  for (int x = 8; x < size - 8; ++x)
    for (const int y : {size / 4, 3 * size / 4})
      EXPECT_NEAR(sure.pixel(x, y)[0] / scene.truth.pixel(x, y)[0], 1, 0.05) << x << ',' << y;
}

TEST_P(EveryDenoiserNotLearned, KeepsTheRangeOfHdr) {
  Image image = constant(64, 64, {0.01f, 0.01f, 0.01f});
  for (int y = 20; y < 44; ++y)
    for (int x = 20; x < 44; ++x)
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = 2e4f;
  Image error = image;
  for (float& value : error.values) value *= 0.05f;
  for (const NoisyImage& noisy : {NoisyImage{image}, NoisyImage{image, error}}) {
    const Image result = filter(noisy);
    EXPECT_NEAR(result.pixel(32, 32)[0], 2e4f, 20);
    EXPECT_NEAR(result.pixel(2, 2)[0], 0.01f, 1e-4f);
    EXPECT_GE(*std::min_element(result.values.begin(), result.values.end()), 0);
    EXPECT_LE(*std::max_element(result.values.begin(), result.values.end()), 2.001e4f);
  }
}

TEST_P(EveryDenoiser, NothingNegativeComesOut) {
  NoisyImage noisy = noisy_view(TestScene(), 4);
  std::mt19937_64 engine(7);
  for (float& value : noisy.color.values)
    if (engine() % 50 == 0) value *= engine() % 2 ? 0 : 300;
  for (const float value : filter(noisy).values) ASSERT_GE(value, 0);
  for (const float value : filter({noisy.color}).values) ASSERT_GE(value, 0);
}

TEST_P(EveryDenoiser, NothingThatIsNotFiniteComesOut) {
  NoisyImage noisy = noisy_view(TestScene(), 1);
  noisy.color.pixel(5, 5)[1] = NAN;
  noisy.color.pixel(40, 40)[0] = INFINITY;
  noisy.color.pixel(71, 71)[2] = -INFINITY;
  noisy.color.pixel(30, 10)[2] = 3e38f;
  noisy.error->pixel(9, 9)[0] = NAN;
  noisy.albedo->pixel(20, 9)[0] = NAN;
  noisy.normal->pixel(30, 9)[0] = INFINITY;
  for (const float value : filter(noisy).values) ASSERT_TRUE(std::isfinite(value));
  for (const float value : filter({constant(5, 5, {NAN, NAN, NAN})}).values)
    ASSERT_NEAR(value, 0, GetParam().learned ? 0.01 : 0);
  const DenoisedHalves halves = denoise_halves(GetParam(), noisy, noisy_view(TestScene(), 2));
  EXPECT_TRUE(std::isfinite(halves.error.rel_rmse));
}

TEST_P(EveryDenoiserNotLearned, OneThreadGivesTheSameBits) {
  const NoisyImage noisy = noisy_view(TestScene(), 3);
  const Image many = filter(noisy);
  const ThreadLimit one(1);
  EXPECT_EQ(filter(noisy).values, many.values);
}

TEST_P(EveryDenoiser, TinyPictures) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 3}}) {
    const Image image = constant(width, height, {1, 2, 3});
    EXPECT_EQ(filter({image, image, image, image}).width, width);
    EXPECT_EQ(filter({image}).values.size(), image.values.size());
  }
}

TEST_P(EveryDenoiser, SizesMustAgree) {
  const Image image = constant(4, 4, {1, 1, 1}), other = constant(4, 5, {1, 1, 1});
  EXPECT_THROW(filter({image, other}), Error);
  EXPECT_THROW(filter({image, {}, other}), Error);
  EXPECT_THROW(filter({image, {}, {}, Image(4, 4, 1)}), Error);
  EXPECT_THROW(filter({Image(4, 4, 1)}), Error);
  EXPECT_THROW(denoise_halves(GetParam(), {image}, {other}), Error);
}

// The estimate knows no truth; it sees what the filter blurs as well as the noise that is left.
TEST_P(EveryDenoiser, ErrorOfTheResultIsEstimated) {
  const TestScene scene;
  for (const bool guided : {true, false}) {
    double truth = 0, noise = 0, estimate = 0, estimated_noise = 0, inside = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
      const auto half = [&](uint64_t half_seed) {
        NoisyImage view = noisy_view(scene, half_seed);
        return guided ? view : NoisyImage{view.color, view.error};
      };
      const NoisyImage first = half(2 * seed), second = half(2 * seed + 1);
      Image mean = first.color;
      for (size_t i = 0; i < mean.values.size(); ++i)
        mean.values[i] = (mean.values[i] + second.color.values[i]) / 2;
      const DenoisedHalves halves = denoise_halves(GetParam(), first, second);
      const double error = difference(halves.picture, scene.truth).rel_mse;
      truth += error;
      noise += difference(mean, scene.truth).rel_mse;
      estimate += square(halves.error.rel_rmse);
      estimated_noise += square(halves.error.noisy);
      inside += halves.error.low <= std::sqrt(error) && std::sqrt(error) <= halves.error.high;
      EXPECT_LE(halves.error.low, halves.error.rel_rmse);
      EXPECT_GE(halves.error.high, halves.error.rel_rmse);
    }
    // Relative to the denoised picture in place of the truth: the difference is small only when the filter's
    // is.
    EXPECT_NEAR(estimated_noise / noise, 1, guided ? 0.05 : 0.2);
    EXPECT_NEAR(std::log2(estimate / truth), 0, guided ? 0.4 : 1) << guided;
    EXPECT_GE(inside, guided ? 4 : 0);
  }
}

const auto name_of = [](const auto& test) { return std::string(test.param.name); };
INSTANTIATE_TEST_SUITE_P(Table, EveryDenoiser, testing::ValuesIn(denoisers().begin(), denoisers().end()),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Table, EveryDenoiserNotLearned, testing::ValuesIn(not_learned()), name_of);

// Squared relative errors of the values of one pixel, in a dark picture that halves and truth agree on but
// for that pixel.
double pixel_error(const Denoiser& denoiser, float first, float second, float error) {
  const auto half = [&](float value) {
    NoisyImage noisy{constant(40, 40, {0.1f, 0.1f, 0.1f}), constant(40, 40, {0.001f, 0.001f, 0.001f})};
    for (int c = 0; c < 3; ++c) {
      noisy.color.pixel(20, 20)[c] = value;
      noisy.error->pixel(20, 20)[c] = error;
    }
    return noisy;
  };
  return square(denoise_halves(denoiser, half(first), half(second)).error.rel_rmse) * 40 * 40;
}

constexpr Denoiser keep_all{"keep_all", "", [](const NoisyImage& noisy) { return noisy.color; }};
constexpr Denoiser darken{"darken", "", [](const NoisyImage& noisy) {
                            return constant(noisy.color.width, noisy.color.height, {0.1f, 0.1f, 0.1f});
                          }};

// Half of a firefly that one half has is left in the mean: an error of many times the dark pixel's light, of
// which six times is the most that counts.
TEST(DenoisedError, FireflyThatStaysCountsManyTimes) {
  EXPECT_NEAR(pixel_error(keep_all, 500, 0.1f, 400), 36, 1);
}

/// Halves of a gray of 1 whose light few samples find: 10 in one pixel of ten, else nothing, of which they
/// are sure.
NoisyImage rarely_lit(uint64_t seed) {
  NoisyImage half{constant(64, 64, {0, 0, 0}), constant(64, 64, {0, 0, 0})};
  test::Random random(seed);
  for (size_t i = 0; i < half.color.values.size(); i += 3) {
    const float value = random.next1() < 0.1 ? 10 : 0;
    for (size_t c = 0; c < 3; ++c) half.color.values[i + c] = half.error->values[i + c] = value;
  }
  return half;
}

// Pixels that both halves left black are no reason to think the truth black, of which 1 would be ten times
// off.
TEST(DenoisedError, SamplesThatAllMissedTheLightAreNotSure) {
  const Denoiser right{"right", "", [](const NoisyImage& noisy) {
                         return constant(noisy.color.width, noisy.color.height, {1, 1, 1});
                       }};
  const DenoisedHalves halves = denoise_halves(right, rarely_lit(1), rarely_lit(2));
  EXPECT_LT(halves.error.rel_rmse, 3);
}

// A light that is taken away is an error of about itself.
TEST(DenoisedError, LightThatIsTakenAwayCountsAboutOnce) {
  EXPECT_NEAR(pixel_error(darken, 500, 500, 10), 1, 0.1);
  EXPECT_NEAR(pixel_error(darken, 400, 600, 100), 1, 0.7);
  EXPECT_NEAR(pixel_error(darken, 500, 0.1f, 400), 0, 0.01) << "seen by one half: no error that is known";
}

TEST(Denoise, SingleBrightSampleIsRemoved) {
  NoisyImage noisy{constant(40, 40, {0.1f, 0.1f, 0.1f}), constant(40, 40, {0.01f, 0.01f, 0.01f})};
  for (int c = 0; c < 3; ++c) noisy.color.pixel(20, 20)[c] = noisy.error->pixel(20, 20)[c] = 500;
  for (const Denoiser& denoiser : not_learned())
    EXPECT_NEAR(denoiser.filter(noisy).pixel(20, 20)[0], 0.1f, 0.02f) << denoiser.name;
}

TEST(Denoise, SureBrightPixelStays) {
  NoisyImage noisy{constant(40, 40, {0.1f, 0.1f, 0.1f}), constant(40, 40, {0.001f, 0.001f, 0.001f})};
  for (int c = 0; c < 3; ++c) noisy.color.pixel(20, 20)[c] = 500;
  for (const Denoiser& denoiser : not_learned()) {
    EXPECT_NEAR(denoiser.filter(noisy).pixel(20, 20)[0], 500, 5) << denoiser.name;
    EXPECT_NEAR(denoiser.filter(noisy).pixel(18, 20)[0], 0.1f, 0.01f) << denoiser.name;
  }
}

// A bright spot that only a few samples found, at a silhouette: the sure dark beside it stays dark.
TEST(Denoise, UnsureLightDoesNotSpread) {
  NoisyImage noisy{constant(40, 40, {0.1f, 0.1f, 0.1f}), constant(40, 40, {0.01f, 0.01f, 0.01f})};
  for (int y = 18; y < 22; ++y)
    for (int x = 18; x < 22; ++x)
      for (int c = 0; c < 3; ++c) {
        noisy.color.pixel(x, y)[c] = 800;
        noisy.error->pixel(x, y)[c] = 200;
      }
  for (const Denoiser& denoiser : not_learned())
    EXPECT_LT(denoiser.filter(noisy).pixel(14, 20)[0], 0.3f) << denoiser.name;
}

}  // namespace
}  // namespace vernier
