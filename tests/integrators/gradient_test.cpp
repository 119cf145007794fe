// SPDX-License-Identifier: Apache-2.0
#include "integrators/gradient_sample.h"

#include <mutex>

#include "core/base/parallel.h"
#include "tests/support/effort.h"
#include "tests/support/random_scenes.h"
#include "tests/support/test_scenes.h"

// Differences between pixels mean the same as the differences of their light.

namespace vernier::test {
namespace {

std::unique_ptr<Integrator> gradient(const IntegratorOptions& options) {
  return make_integrator("gradient", options);
}

/// One pixel's answer, with its side of the difference to the other.
struct Side {
  Vec3d light{0, 0, 0};  ///< that the difference is of
  Vec3d difference{0, 0, 0};
};

/// The sample of the pixel of `ray` with the pixel of `other` in the place `there`.
Side side(const Integrator& integrator, const Scene& scene, const Ray& ray, const Ray& other, size_t there,
          Sampler& sampler) {
  GradientSample sample;
  sample.active[there] = true;
  sample.rays[there] = other;
  SampleContext context;
  context.gradients = &sample;
  const Estimate estimate = integrator.estimate(scene, ray, sampler, context);
  return {Vec3d(estimate.radiance) - Vec3d(sample.primal_only), Vec3d(sample.differences[there])};
}

Ray turned(Ray ray, const Vec3f& by) {
  ray.direction = normalize(ray.direction + by);
  return ray;
}

/// Two pixels, each as wide as `width` along each axis about its ray.
struct Pair {
  Ray first, second;
  float width;
};

/// By channel: the difference of two pixels as both sides tell it, less that of their light.
std::array<Samples, 3> excess(const Scene& scene, int max_depth, const Pair& pair, uint64_t seed,
                              uint64_t samples) {
  constexpr int sets = 16;
  const auto integrator = gradient({.max_depth = max_depth});
  std::array<Samples, 3> result;
  for (uint32_t set = 0; set < sets; ++set) {
    Vec3d sum(0, 0, 0);
    for (uint32_t i = 0; i < uint32_t(samples); ++i)
      for (const int other : {0, 1}) {
        Sampler sampler(2 * set + uint32_t(other), i, seed);
        const Vec2f u = sampler.next2();
        const Vec3f shake = (Vec3f(u.x, u.y, u.x * u.y) - Vec3f(0.5f)) * pair.width;
        const Ray first = turned(pair.first, shake), second = turned(pair.second, shake);
        const Side found = other ? side(*integrator, scene, second, first, 1, sampler)
                                 : side(*integrator, scene, first, second, 0, sampler);
        sum += other ? -found.difference - found.light : found.difference + found.light;
      }
    for (int c = 0; c < 3; ++c) result[size_t(c)].add(sum[c] / double(samples));
  }
  return result;
}

double p_value(const std::array<Samples, 3>& excess) {
  double p = 1;
  for (const Samples& channel : excess)
    if (std::abs(channel.mean()) > 1e-6) p = std::min(p, mean_p_value(channel, 0));
  return p;
}

TEST(Gradient, DifferencesAreThoseOfTheLightInRandomScenes) {
  const uint64_t count = asked_or("VERNIER_RANDOM_SCENES", 64 / thinning);
  const double significance = sidak(1e-3, count * 2 * 2);
  std::mutex mutex;
  parallel_for(count, [&](size_t k) {
    const uint64_t seed = k + 1;
    const RandomScene random = random_scene(seed);
    const Scene scene(random.description, {"embree"});
    if (scene.volumes().scatter()) return;
    for (size_t r = 0; r < random.rays.size(); ++r)
      for (const float apart : {2e-3f, 0.1f}) {
        double last = 1;
        const Ray& ray = random.rays[r];
        const Pair pair{ray, turned(ray, Vec3f(apart, 0, -apart)), 1e-3f};
        const bool holds = confirmed(significance, 256, [&](uint64_t run, uint64_t samples) {
          return last = p_value(excess(scene, random.max_depth, pair, 1000 * seed + 10 * r + run, samples));
        });
        if (holds) continue;
        const std::lock_guard lock(mutex);
        ADD_FAILURE() << "random scene " << seed << ", ray " << r << ", " << apart << " apart: p " << last;
      }
  });
}

// Paths that leave dark surfaces of different albedo for a bright room survive roulette with probabilities of
// their own.
TEST(Gradient, DifferencesAreThoseOfTheLightUnderRoulette) {
  const Scene scene =
      SceneBuilder()
          .add(box({-1, 0, -1}, {1, 2, 1}, true), diffuse(0.7f))
          .add(parallelogram({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), emitter(5))
          .add(parallelogram({-0.9f, 0.1f, -0.9f}, {0, 0, 1.8f}, {0.9f, 0, 0}), diffuse(0.02f))
          .add(parallelogram({0, 0.1f, -0.9f}, {0, 0, 1.8f}, {0.9f, 0, 0}), diffuse(0.1f))
          .build();
  const Vec3f eye(0, 1, 0.9f);
  const Pair pair{ray_through(eye, {-0.1f, 0.1f, 0}), ray_through(eye, {0.1f, 0.1f, 0}), 1e-3f};
  EXPECT_TRUE(confirmed(1e-4, 2048 / thinning, [&](uint64_t run, uint64_t samples) {
    return p_value(excess(scene, 12, pair, run, samples));
  }));
}

// With the same ray beside it, nothing differs.
TEST(Gradient, IsZeroBetweenPixelsThatSeeTheSame) {
  const RandomScene random = random_scene(7);
  const Scene scene(random.description, {"embree"});
  const auto integrator = gradient({.max_depth = random.max_depth});
  for (uint32_t i = 0; i < 200; ++i) {
    Sampler sampler(0, i, 1);
    sampler.next2();
    const Side found = side(*integrator, scene, random.rays[0], random.rays[0], 0, sampler);
    const double size = std::max(found.light.x, std::max(found.light.y, found.light.z));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found.difference[c], 0, 2e-4 * size + 1e-6) << i;
  }
}

// What moves is elsewhere at another time: then each pixel counts for itself.
TEST(Gradient, IsAPixelsOwnLightWhereTheOtherIsOfAnotherTime) {
  const RandomScene random = random_scene(7);
  const Scene scene(random.description, {"embree"});
  const auto integrator = gradient({.max_depth = random.max_depth});
  Ray later = random.rays[0];
  later.time = random.rays[0].time + 0.1f;
  for (uint32_t i = 0; i < 100; ++i) {
    Sampler sampler(0, i, 1);
    const Side found = side(*integrator, scene, random.rays[0], later, 0, sampler);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found.difference[c], -found.light[c], 1e-5 * found.light[c]);
  }
}

}  // namespace
}  // namespace vernier::test
