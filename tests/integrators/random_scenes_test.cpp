// SPDX-License-Identifier: Apache-2.0
#include "tests/support/random_scenes.h"

#include <fstream>

#include "core/base/parallel.h"
#include "tests/support/effort.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_scenes.h"

// Scenes that nobody had in mind: all techniques find the same light, on two accelerators that share nothing.
// VERNIER_RANDOM_SCENES=N tries N of them.

namespace vernier::test {
namespace {

struct Technique {
  const char* name;
  LightSampling sampling;
  bool roulette;
  const char* accelerator;
  float spread = 0;  ///< of the pixel
};
constexpr Technique reference{"mis", LightSampling::mis, true, "bvh"};
constexpr Technique others[] = {{"light", LightSampling::light, true, "bvh"},
                                {"bsdf", LightSampling::bsdf, true, "bvh"},
                                {"mis without roulette", LightSampling::mis, false, "bvh"},
                                {"mis with embree in a noisy pixel", LightSampling::mis, true, "embree", 10}};

/// Which surfaces with an alpha a ray meets is a matter of its bits: one ray many times is no mean.
Ray shaken(Ray ray, const Vec2f& u) {
  ray.direction = normalize(ray.direction + (Vec3f(u.x, u.y, u.x * u.y) - Vec3f(0.5f)) * 1e-3f);
  return ray;
}

/// By channel.
std::array<Samples, 3> radiance(const Scene& scene, const Technique& technique, const RandomScene& random,
                                const Ray& ray, uint64_t seed, uint64_t factor) {
  constexpr int sets = 32, samples = 512;
  IntegratorOptions options;
  options.max_depth = random.max_depth;
  options.light_sampling = technique.sampling;
  options.russian_roulette = technique.roulette;
  const auto integrator = path(options);
  std::array<Samples, 3> result;
  for (uint32_t set = 0; set < sets; ++set) {
    Vec3d mean(0, 0, 0);
    const auto count = uint32_t(samples * factor);
    for (uint32_t i = 0; i < count; ++i) {
      Sampler sampler(set, i, seed);
      mean += Vec3d(
          integrator->estimate(scene, shaken(ray, sampler.next2()), sampler, {technique.spread}).radiance);
    }
    for (int c = 0; c < 3; ++c) result[size_t(c)].add(mean[c] / count);
  }
  return result;
}

/// Smallest p-value of the channels; rare bright samples make a t-test's tails too long to take it at its
/// word far out, so the differences that count are those that a sixteenfold repeat confirms.
double difference(const std::array<Samples, 3>& a, const std::array<Samples, 3>& b) {
  double p = 1;
  for (size_t c = 0; c < 3; ++c) {
    // What float sums over a path can differ by.
    if (std::abs(a[c].mean() - b[c].mean()) <= 1e-5 * std::abs(a[c].mean())) continue;
    p = std::min(p, welch_p_value(a[c], b[c]));
  }
  return p;
}

std::string written(const RandomScene& random, uint64_t seed) {
  const auto file =
      std::filesystem::temp_directory_path() / ("vernier-random-scene-" + std::to_string(seed) + ".gltf");
  std::ofstream(file) << to_gltf(random.description);
  return file.string();
}

TEST(RandomScenes, TechniquesAgree) {
  const uint64_t count = asked_or("VERNIER_RANDOM_SCENES", 240 / thinning);
  const double significance = sidak(1e-3, count * 2 * std::size(others));
  std::mutex mutex;
  parallel_for(count, [&](size_t k) {
    const uint64_t seed = k + 1;
    const RandomScene random = random_scene(seed);
    const Scene bvh(random.description, {"bvh"}), embree(random.description, {"embree"});
    for (size_t r = 0; r < random.rays.size(); ++r) {
      const Ray& ray = random.rays[r];
      Baseline<std::array<Samples, 3>> by_reference(
          [&](uint64_t s, uint64_t factor) { return radiance(bvh, reference, random, ray, 2 * s, factor); });
      for (const Technique& technique : others) {
        if (random.has_lamps && technique.sampling == LightSampling::bsdf) continue;
        const Scene& scene = std::string_view(technique.accelerator) == "embree" ? embree : bvh;
        const bool agree = confirmed(significance, 1, [&](uint64_t s, uint64_t factor) {
          return difference(by_reference(s, factor),
                            radiance(scene, technique, random, ray, 2 * s + 1, factor));
        });
        if (agree) continue;
        const std::lock_guard lock(mutex);
        ADD_FAILURE() << "scene " << seed << " (" << written(random, seed) << "), ray " << r << ", depth "
                      << random.max_depth << ": mis against " << technique.name;
      }
    }
  });
}

}  // namespace
}  // namespace vernier::test
