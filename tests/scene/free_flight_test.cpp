// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "scene/lights/lamps_along_ray.h"
#include "scene/medium.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace vernier::test {
namespace {

const Medium colored{{0.2f, 3, 0}, {1, 1, 1}, {0.1f, 2.5f, 0}, 0};

/// Samples against cells of equal width up to `end`, and one beyond.
double chi_square(const std::function<double(double, double)>& share, double end,
                  const std::function<double(Random&)>& draw) {
  constexpr int cells = 40, samples = 100'000;
  std::vector<double> observed(cells + 1), expected(cells + 1);
  double all = 0;
  for (int i = 0; i < cells; ++i) {
    expected[size_t(i)] = samples * share(end * i / cells, end * (i + 1) / cells);
    all += expected[size_t(i)];
  }
  expected[cells] = std::max(0., samples - all);
  Random random(5);
  for (int i = 0; i < samples; ++i)
    ++observed[size_t(std::clamp(draw(random) / end * cells, 0., double(cells)))];
  return chi_square_p_value(observed, expected);
}

/// By the midpoint rule, fine beside what the densities here do.
double integral(const std::function<double(double)>& f, double from, double to) {
  constexpr int steps = 2000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(from + (to - from) * (i + 0.5) / steps);
  return sum * (to - from) / steps;
}

TEST(FreeFlight, DistancesFollowTheirDensity) {
  for (const Rgb& carried : {Rgb(1, 1, 1), Rgb(0, 2, 0.1f), Rgb(0, 0, 0)}) {
    const FreeFlight flight(colored, carried, 1e9f);
    EXPECT_GT(chi_square(
                  [&](double a, double b) {
                    return integral([&](double t) { return double(flight.pdf(float(t))); }, a, b);
                  },
                  4, [&](Random& random) { return double(flight.sample(double(random.next1())).distance); }),
              1e-4);
  }
}

// Whatever the shares of channels, the mean weight of what passes is the transmittance, that of what is
// scattered all that is lost by scattering.
TEST(FreeFlight, WeightsAreRightInTheMean) {
  const float length = 0.7f;
  for (const Rgb& carried : {Rgb(1, 1, 1), Rgb(3, 0.5f, 0.1f)}) {
    const FreeFlight flight(colored, carried, length);
    std::array<Samples, 3> passed, scattered;
    Random random(3);
    for (int i = 0; i < 200'000; ++i) {
      const auto sample = flight.sample(double(random.next1()));
      for (int c = 0; c < 3; ++c) {
        passed[size_t(c)].add(sample.is_scattered ? 0 : double(sample.weight[c]));
        scattered[size_t(c)].add(sample.is_scattered ? double(sample.weight[c]) : 0);
        ASSERT_LE(sample.weight[c] * carried[c], (carried.x + carried.y + carried.z) * 1.0001f);
      }
    }
    const Rgb left = transmittance(colored, length);
    for (int c = 0; c < 3; ++c) {
      const double lost = colored.extinction[c] > 0
                              ? double(colored.scattering[c] / colored.extinction[c] * (1 - left[c]))
                              : 0;
      EXPECT_NEAR(passed[size_t(c)].mean(), double(left[c]), 5 * passed[size_t(c)].standard_error() + 1e-6);
      EXPECT_NEAR(scattered[size_t(c)].mean(), lost, 5 * scattered[size_t(c)].standard_error() + 1e-6);
    }
  }
}

// Paths may carry next to nothing, or light of one color alone.
TEST(FreeFlight, IsDefinedAtTheLimits) {
  for (const Rgb& carried : {Rgb(0, 0, 0), Rgb(1e-39f, 1e-42f, 0), Rgb(1, 1e-30f, 0), Rgb(0, 0.3f, 0),
                             Rgb(0.1f, 0.2f, 0.7f), Rgb(3e38f, 3e38f, 3e38f)})
    for (const float length : {0.f, 1e-20f, 1.f, std::numeric_limits<float>::infinity()}) {
      const FreeFlight flight(colored, carried, length);
      for (const double u : {0., 1e-300, 0.3, 0.999999, 0x1.fffffffffffffp-1}) {
        const auto sample = flight.sample(u);
        EXPECT_TRUE(is_finite(sample.weight)) << carried << ", length " << length << ", u " << u;
        EXPECT_GE(sample.distance, 0);
      }
    }
}

PunctualLightDescription lamp_at(const Vec3f& position, float cone, float range, float intensity = 1) {
  PunctualLightDescription lamp;
  lamp.intensity = intensity;
  lamp.to_world.origin = position;
  lamp.range = range;
  if (cone > 0) {
    lamp.kind = PunctualLightDescription::Kind::spot;
    lamp.outer_cone = cone;
    lamp.to_world.z = normalize(Vec3f(0.3f, 1, -0.4f));
  }
  return lamp;
}

TEST(LampsAlongRay, PlacesFollowTheirDensity) {
  const Ray ray{{0, 0, 0}, 0, normalize(Vec3f(1, 0.1f, 0.2f))};
  for (const size_t count : {1u, 3u, 40u}) {
    std::vector<PunctualLight> lights;
    for (uint32_t i = 0; i < count; ++i)
      lights.emplace_back(
          lamp_at({float(i % 7) + 0.5f, 1 + 0.1f * float(i % 3), 0.2f * float(i % 5)}, i % 3 == 1 ? 0.5f : 0,
                  i % 3 == 2 ? 2.f : std::numeric_limits<float>::infinity(), float(1 + i % 4)));
    Lamps lamps;
    for (uint32_t i = 0; i < count; ++i) lamps.add(lights[i], i);
    const LampsAlongRay along(lamps, ray, 0.3f, 6);
    SCOPED_TRACE(testing::Message() << count << " lamps");
    const auto density = [&](double t) {
      double sum = 0;
      for (uint32_t i = 0; i < count; ++i) sum += double(along.pdf(&lights[i], float(t)));
      return sum;
    };
    EXPECT_GT(chi_square([&](double a, double b) { return integral(density, a, b); }, 6,
                         [&](Random& random) {
                           const float u = random.next1(), v = random.next1();
                           const auto sample = along.sample(u, v);
                           if (!sample) return 1e9;
                           EXPECT_NEAR(along.pdf(&lights[sample->light], sample->t), sample->pdf,
                                       1e-3f * sample->pdf);
                           return double(sample->t);
                         }),
              1e-4);
  }
}

// A spot lights only what its cone holds: there is no density elsewhere.
TEST(LampsAlongRay, ConesEnd) {
  const Ray ray{{0, 0, 0}, 0, {1, 0, 0}};
  PunctualLightDescription spot = lamp_at({2, 1, 0}, 0.3f, std::numeric_limits<float>::infinity());
  spot.to_world.z = {0, 1, 0};  // shines down
  const PunctualLight down(spot);
  Lamps lamps;
  lamps.add(down, 0);
  const LampsAlongRay along(lamps, ray, 0, std::numeric_limits<float>::infinity());
  const float half = std::tan(0.3f);
  EXPECT_EQ(along.pdf(&down, 2 - 1.01f * half), 0);
  EXPECT_EQ(along.pdf(&down, 2 + 1.01f * half), 0);
  EXPECT_NEAR(along.pdf(&down, 2), 1 / 0.6f, 1e-3f);
  spot.to_world.z = {0, -1, 0};  // up, away from the ray
  const PunctualLight up(spot);
  Lamps away;
  away.add(up, 0);
  EXPECT_FALSE(LampsAlongRay(away, ray, 0, std::numeric_limits<float>::infinity()).sample(0.5f, 0.5f));
}

}  // namespace
}  // namespace vernier::test
