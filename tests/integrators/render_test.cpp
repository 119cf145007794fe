// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/render.h"

#include <fmt/format.h>

#include <chrono>
#include <future>

#include "core/base/parallel.h"
#include "scene/camera.h"
#include "tests/support/effort.h"
#include "tests/support/statistics.h"
#include "tests/support/test_scenes.h"

namespace vernier::test {
namespace {

Scene scene() {
  return SceneBuilder()
      .add(box({-1, 0, -1}, {1, 2, 1}, true), plastic(0.4f))
      .add(parallelogram({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), emitter(5))
      .add(sphere({0, 0.5f, 0}, 0.4f, 8, 16), glass(0.2f))
      .build();
}

CameraDescription camera_description() {
  CameraDescription camera;
  camera.yfov = 1.2f;
  camera.to_world.origin = {0, 1, 0.95f};
  return camera;
}

Image picture(const Scene& scene, const Integrator& integrator, const RenderSettings& options) {
  const Camera camera(camera_description(), options.width, options.height);
  const std::atomic<bool> stop = false;
  return render(scene, camera, integrator, options, stop).film.image();
}

// The same bytes for any number of threads, for each integrator of the table.
TEST(Render, SameForAnyNumberOfThreads) {
  const Scene room = scene();
  RenderSettings options;
  options.width = 50;
  options.height = 37;
  options.limits.spp = 20;  // the last four as planned
  for (const IntegratorEntry& entry : integrators()) {
    const auto integrator = entry.make({});
    Image first;
    for (const unsigned threads : {1u, 2u, 7u}) {
      const ThreadLimit limit(threads);
      const Image image = picture(room, *integrator, options);
      if (first.empty())
        first = image;
      else
        EXPECT_EQ(image.values, first.values) << entry.name << " with " << threads << " threads";
    }
  }
}

// A crop shows what the full picture shows there.
TEST(Render, CropIsAPartOfTheWhole) {
  const Scene room = scene();
  const auto integrator = path({});
  RenderSettings options;
  options.width = 40;
  options.height = 30;
  options.limits.spp = 4;
  const Image whole = picture(room, *integrator, options);
  options.crop = {11, 7, 18, 13};
  const Image part = picture(room, *integrator, options);
  ASSERT_EQ(part.width, 18);
  ASSERT_EQ(part.height, 13);
  for (int y = 0; y < 13; ++y)
    for (int x = 0; x < 18; ++x) EXPECT_EQ(rgb_at(part, x, y), rgb_at(whole, x + 11, y + 7));
}

TEST(Render, SeedsDiffer) {
  const Scene room = scene();
  RenderSettings options;
  options.width = options.height = 8;
  options.limits.spp = 2;
  const Image a = picture(room, *path({}), options);
  options.seed = 1;
  EXPECT_NE(picture(room, *path({}), options).values, a.values);
}

TEST(Render, StopsWithAPicture) {
  const Scene room = scene();
  RenderSettings options;
  options.width = options.height = 8;
  options.limits.spp = 0;
  options.limits.seconds = 0.01;
  const Camera camera(camera_description(), 8, 8);
  std::atomic<bool> stop = false;
  const RenderResult timed = render(room, camera, *path({}), options, stop);
  EXPECT_EQ(timed.reason, StopReason::time);
  EXPECT_GE(timed.samples, 64u);
  EXPECT_EQ(timed.bad_samples, 0u);
  stop = true;
  EXPECT_EQ(render(room, camera, *path({}), options, stop).reason, StopReason::interrupted);
}

/// Mean 1 everywhere; every other patch of the picture has rare bright samples.
class Fireflies : public Integrator {
 public:
  explicit Fireflies(float share) : share_(share) {}
  Estimate estimate(const Scene&, const Ray& ray, Sampler& sampler, const SampleContext&) const override {
    sampler.start_block(1);
    const float u = sampler.next1();
    Estimate out;
    const bool calm = std::lround(10 * ray.direction.x) % 2 == 0;
    const float value = calm ? 0.5f + u : (u < share_ ? 1 / share_ : 0);
    out.radiance = {value, value, value};
    return out;
  }

 private:
  float share_;
};

/// Means of pictures of the same Fireflies, each of a seed of its own.
std::vector<double> picture_means(const Fireflies& integrator, const RenderSettings& asked, uint64_t pictures,
                                  uint64_t seed) {
  const Scene nothing = SceneBuilder().build();
  const Camera camera(camera_description(), asked.width, asked.height);
  const std::atomic<bool> stop = false;
  std::vector<double> means(pictures);
  parallel_for(pictures, [&](size_t i) {
    RenderSettings options = asked;
    options.seed = seed * 10'000'000 + i;
    const Image image = render(nothing, camera, integrator, options, stop).film.image();
    for (const float value : image.values) means[i] += value / double(image.values.size());
  });
  return means;
}

void print_mean(const Samples& means) {
  fmt::print("mean {:.5f}, detectable bias {:.3f} %\n", means.mean(),
             100 * detectable_bias(means.standard_error(), 1e-3));
}

// Adaptive sampling does not change what the image converges to, though whether a pixel gets more samples
// depends on fireflies that were found. The difference from even sampling with the same seed, which shares
// most samples, has a smaller spread than the mean itself. Significance 1e-3; detects a bias of 0.02 % nine
// times in ten (the test prints it).
TEST(Render, AdaptiveSamplingIsUnbiased) {
  RenderSettings options;
  options.width = options.height = 8;
  options.limits.spp = 48;
  EXPECT_TRUE(confirmed(1e-3, 26'000 / thinning, [&](uint64_t seed, uint64_t pictures) {
    const auto mean_of = [&](bool adaptive) {
      options.adaptive = adaptive;
      return picture_means(Fireflies(0.2f), options, pictures, seed);
    };
    const std::vector<double> adaptive = mean_of(true), even = mean_of(false);
    Samples differences;
    for (size_t i = 0; i < adaptive.size(); ++i) differences.add(adaptive[i] - even[i]);
    print_mean(differences);
    return mean_p_value(differences, 0);
  }));
}

// Nor does stopping at an error: a render ends when its estimate is low, which may not mean that its pixels
// are. Detects a bias of 0.1 %.
TEST(Render, StoppingAtAnErrorIsUnbiased) {
  RenderSettings options;
  options.width = options.height = 16;
  options.limits.spp = 0;
  options.limits.error = 0.1;
  EXPECT_TRUE(confirmed(1e-3, 1000 / thinning, [&](uint64_t seed, uint64_t pictures) {
    Samples means;
    for (const double mean : picture_means(Fireflies(0.05f), options, pictures, seed)) means.add(mean);
    print_mean(means);
    return mean_p_value(means, 1);
  }));
}

/// Every third sample is not a number.
class Broken : public Integrator {
 public:
  Estimate estimate(const Scene&, const Ray&, Sampler& sampler, const SampleContext&) const override {
    sampler.start_block(1);
    Estimate out;
    if (sampler.next1() < 1 / 3.f) out.radiance.x = std::numeric_limits<float>::quiet_NaN();
    return out;
  }
};

// Which bad samples are kept does not depend on the order in which tiles are done.
TEST(Render, KeepsTheSameBadSamplesForAnyNumberOfThreads) {
  const Scene nothing = SceneBuilder().build();
  RenderSettings options;
  options.width = options.height = 64;
  options.limits.spp = 6;
  const Camera camera(camera_description(), options.width, options.height);
  const std::atomic<bool> stop = false;
  std::vector<BadSample> first;
  for (const unsigned threads : {1u, 2u, 7u}) {
    const ThreadLimit limit(threads);
    const RenderResult result = render(nothing, camera, Broken(), options, stop);
    EXPECT_GT(result.bad_samples, 6000u);
    EXPECT_EQ(result.bad_sample_examples.size(), 8u);
    EXPECT_TRUE(std::is_sorted(result.bad_sample_examples.begin(), result.bad_sample_examples.end()));
    EXPECT_LE(result.bad_sample_examples.back().x, 1);
    if (first.empty()) first = result.bad_sample_examples;
    EXPECT_EQ(result.bad_sample_examples, first) << threads;
  }
}

// An observer that does not return, like one that writes to a pipe which nobody reads, does not keep the
// picture from being rendered: here it waits for the save that follows the last pass.
TEST(Render, GoesOnWhileTheObserverIsStuck) {
  const Scene nothing = SceneBuilder().build();
  RenderSettings options;
  options.width = options.height = 64;
  options.limits.spp = 0;
  options.limits.seconds = 1;
  const Camera camera(camera_description(), options.width, options.height);
  const std::atomic<bool> stop = false;
  std::promise<void> rendered;
  bool was_told = false, was_freed = false;
  RenderCallbacks callbacks;
  callbacks.on_progress = [&, waiting = rendered.get_future().share()](const RenderProgress&) {
    was_told = true;
    was_freed = waiting.wait_for(std::chrono::minutes(2)) == std::future_status::ready;
  };
  callbacks.on_checkpoint = [&](const RenderState&) { rendered.set_value(); };
  render(nothing, camera, Fireflies(0.5f), options, stop, std::move(callbacks));
  EXPECT_TRUE(was_told);
  EXPECT_TRUE(was_freed);
}

// Nor does one that fails.
TEST(Render, GoesOnWhenTheObserverThrows) {
  const Scene nothing = SceneBuilder().build();
  RenderSettings options;
  options.width = options.height = 64;
  options.limits.spp = 0;
  options.limits.seconds = 0.6;
  const Camera camera(camera_description(), options.width, options.height);
  const std::atomic<bool> stop = false;
  int told = 0;
  RenderCallbacks callbacks;
  callbacks.on_progress = [&](const RenderProgress&) {
    ++told;
    throw std::runtime_error("the pipe is closed");
  };
  EXPECT_EQ(render(nothing, camera, Fireflies(0.5f), options, stop, std::move(callbacks)).reason,
            StopReason::time);
  EXPECT_EQ(told, 1);
}

struct Stopping {
  float share;  ///< of the samples that have light, in every other patch
  int side;
  double asked;
};

// What was asked for is what comes out: at most a tenth more, in 19 of 20 pictures. Stopping at the first
// look that is good enough favours estimates that are too low, in small pictures with rare light most.
TEST(Render, StopsAtTheErrorAskedFor) {
  const Scene nothing = SceneBuilder().build();
  for (const Stopping& stopping : {Stopping{0.2f, 48, 0.15}, Stopping{0.01f, 16, 0.5}}) {
    const Fireflies integrator(stopping.share);
    RenderSettings options;
    options.width = options.height = stopping.side;
    options.limits.spp = 0;
    options.limits.error = stopping.asked;
    const Camera camera(camera_description(), options.width, options.height);
    const std::atomic<bool> stop = false;
    for (const bool adaptive : {false, true}) {
      options.adaptive = adaptive;
      int too_wrong = 0;
      double largest = 0, spp = 0;
      for (options.seed = 1; options.seed <= 20; ++options.seed) {
        const RenderResult result = render(nothing, camera, integrator, options, stop);
        EXPECT_EQ(result.reason, StopReason::error);
        double squares = 0;
        for (const float value : result.film.image().values) squares += square(value - 1.0);
        const double error = std::sqrt(squares / (square(double(stopping.side)) * 3) / 1.01);
        largest = std::max(largest, error);
        spp += double(result.samples) / square(double(stopping.side)) / 20;
        too_wrong += error > 1.1 * options.limits.error;
      }
      fmt::print("{} too wrong, {:.0f} samples a pixel\n", too_wrong, spp);
      EXPECT_LE(too_wrong, 1) << stopping.share << (adaptive ? " adaptive" : " even");
      EXPECT_GT(largest, 0.5 * options.limits.error) << stopping.share << adaptive;
    }
  }
}

}  // namespace
}  // namespace vernier::test
