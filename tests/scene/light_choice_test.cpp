// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>

#include "core/sampling/warp.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/test_scenes.h"

// The choice among lights, on sets of them that nobody would arrange: every light that shines on a point can
// be chosen there, probabilities are those of the choices, and they add up.

namespace vernier::test {
namespace {

Vec3f random_direction(Random& random) { return sample_sphere(random.next2()); }

Vec3f random_place(Random& random, float size) {
  const Vec2f u = random.next2();
  return Vec3f(u.x, u.y, random.next1()) * size;
}

/// `axis`, the same turned by up to `most` radians, or the opposite of either.
Vec3f near_axis(const Vec3f& axis, float most, Random& random) {
  const Vec3f turned = normalize(axis + random_direction(random) * (most * random.next1()));
  return random.next1() < 0.5f ? turned : -turned;
}

PunctualLightDescription random_spot(const Vec3f& axis, Random& random) {
  PunctualLightDescription light;
  light.kind = PunctualLightDescription::Kind::spot;
  constexpr std::array<float, 6> outer{1e-3f, 0.05f, 0.5f, 1, 1.5f, pi / 2};
  light.outer_cone = outer[size_t(random.next1() * outer.size())];
  light.inner_cone = light.outer_cone * random.next1() * 0.99f;
  const Frame frame = Frame::from_normal(-axis);
  light.to_world.z = -axis;
  light.to_world.x = frame.to_world({1, 0, 0});
  light.to_world.y = frame.to_world({0, 1, 0});
  return light;
}

/// `count` lights within a cube of that size: points, spots of all widths, triangles with one side and with
/// two; some at one place, some on one plane, their axes all over or close to one line, powers unequal.
Scene random_lights(int count, float size, Random& random) {
  SceneBuilder builder;
  // Something to hold the scene's bounds.
  builder.add(parallelogram(Vec3f(-size, -size, -size), {3 * size, 0, 0}, {0, 0, 3 * size}), diffuse(0.5f));
  const Vec3f line = random_direction(random);
  const bool aligned = random.next1() < 0.5f, flat = random.next1() < 0.3f;
  const float turn = std::pow(10.f, -7 * random.next1());
  const float only = random.next1();
  Vec3f place = random_place(random, size);
  for (int i = 0; i < count; ++i) {
    if (random.next1() < 0.8f) place = random_place(random, size);
    if (flat) place.y = 0.5f * size;
    const Vec3f axis = aligned ? near_axis(line, turn, random) : random_direction(random);
    const float kind = only < 0.4f ? random.next1() : only;
    const float intensity = std::pow(10.f, 4 * random.next1() - 2);
    if (kind < 0.6f) {
      PunctualLightDescription light = kind < 0.1f ? PunctualLightDescription() : random_spot(axis, random);
      light.intensity = intensity;
      light.to_world.origin = place;
      builder.add(light);
    } else {
      MaterialDescription material = emitter(intensity);
      material.double_sided = kind > 0.8f;
      const Frame frame = Frame::from_normal(axis);
      const float side = size * std::pow(10.f, -3 * random.next1());
      MeshDescription mesh = parallelogram(place, frame.to_world({side, 0, 0}), frame.to_world({0, side, 0}));
      if (random.next1() < 0.5f) mesh.triangles.pop_back();
      builder.add(mesh, material);
    }
  }
  return builder.build();
}

/// A unit vector at that angle from `axis`.
Vec3f turned_from(const Vec3f& axis, float angle, Random& random) {
  const float around = 2 * pi * random.next1();
  return Frame::from_normal(axis).to_world(
      {std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around), std::cos(angle)});
}

/// A point that a light reaches just so: by the rim of its cone, just above the point's horizon.
SurfacePoint grazed_point(const LightBounds& light, float size, Random& random) {
  const auto little = [&] { return std::pow(10.f, -1 - 6 * random.next1()); };
  const float emission = std::acos(std::clamp(light.cos_emission, -1.f, 1.f));
  const Vec3f out = turned_from(light.axis, emission * (1 - little()), random);
  SurfacePoint point;
  point.error = {0, 0, 0};
  point.position = light.box.center() + out * (size * std::pow(10.f, 1 - 4 * random.next1()));
  point.ng = turned_from(-out, pi / 2 - little(), random);
  return point;
}

/// A point among the lights, near one of them, on the edge of what one shines on, or far off.
SurfacePoint random_receiver(const Scene& scene, float size, Random& random) {
  SurfacePoint point;
  point.error = {0, 0, 0};
  point.position = random_place(random, size);
  point.ng = random.next1() < 0.2f ? Vec3f(0, 1, 0) : random_direction(random);
  const float where = random.next1();
  if (where < 0.2f) point.position = (point.position - Vec3f(0.5f * size)) * 20.f;
  if (where < 0.4f) return point;
  const auto light = scene.lights()[size_t(random.next1() * float(scene.lights().size()))].bounds();
  if (!light) return point;
  if (where < 0.7f) return grazed_point(*light, size, random);
  point.position =
      light->box.center() + random_direction(random) * (size * std::pow(10.f, -5 * random.next1()));
  return point;
}

bool may_shine(const Light& light, const SurfacePoint& from, const Vec3f& normal, Random& random) {
  for (int i = 0; i < 8; ++i) {
    const auto sample = light.sample(from, random.next2());
    if (sample && !is_black(sample->radiance) && (normal == Vec3f(0, 0, 0) || dot(sample->wi, normal) > 0))
      return true;
  }
  return false;
}

/// At one receiver: probabilities of all lights, and whether a light is missed.
double sum_of_probabilities(const Scene& scene, const SurfacePoint& from, const LightReceiver& receiver,
                            Random& random) {
  const LightSet& lights = scene.lights();
  double sum = 0;
  for (size_t i = 0; i < lights.size(); ++i) {
    const float prob = lights.prob(receiver, i);
    sum += prob;
    EXPECT_GE(prob, 0);
    if (!(prob > 0)) {
      EXPECT_FALSE(may_shine(lights[i], from, receiver.normal, random))
          << "light " << i << " of " << lights.size() << " never reaches " << from.position;
    }
  }
  return sum;
}

TEST(LightChoice, FindsEveryLightThatShines) {
  Random random(11);
  for (int trial = 0; trial < 600 / thinning; ++trial) {
    const int count = trial % 3 == 0 ? 1 + trial % 20 : 1 + trial % 200;
    const float size = std::pow(10.f, 4 * random.next1() - 2);
    const Scene scene = random_lights(count, size, random);
    for (int i = 0; i < 60; ++i) {
      const SurfacePoint from = random_receiver(scene, size, random);
      const LightReceiver receiver{from.position, i % 2 ? from.ng : Vec3f(0, 0, 0)};
      EXPECT_LE(sum_of_probabilities(scene, from, receiver, random), 1 + 1e-5);
    }
    ASSERT_FALSE(HasFailure()) << "trial " << trial;
  }
}

// Significance 1e-3 for all of it together.
TEST(LightChoice, FrequenciesAreTheProbabilities) {
  Random random(12);
  constexpr int trials = 60, draws = 20'000 / thinning;
  for (int trial = 0; trial < trials; ++trial) {
    const float size = std::pow(10.f, 4 * random.next1() - 2);
    const Scene scene = random_lights(1 + 4 * trial % 200, size, random);
    const LightSet& lights = scene.lights();
    const SurfacePoint from = random_receiver(scene, size, random);
    const LightReceiver receiver{from.position, trial % 2 ? from.ng : Vec3f(0, 0, 0)};
    std::map<const Light*, size_t> index;
    std::vector<double> expected, counted(lights.size() + 1);
    double sum = 0;
    for (size_t i = 0; i < lights.size(); ++i) {
      index[&lights[i]] = i;
      expected.push_back(lights.prob(receiver, i) * double(draws));
      sum += lights.prob(receiver, i);
    }
    index[nullptr] = lights.size();
    // What is left of the probability is that of no light; rounding of the sum is not.
    expected.push_back(sum < 1 - 1e-5 ? (1 - sum) * draws : 0);
    for (int i = 0; i < draws; ++i) {
      const auto [light, prob] = lights.choose(receiver, random.next1());
      ASSERT_TRUE(index.count(light));
      ++counted[index[light]];
      if (light) {
        EXPECT_FLOAT_EQ(prob, lights.prob(receiver, index[light]));
      }
    }
    EXPECT_GT(chi_square_p_value(counted, expected), sidak(1e-3, trials)) << "trial " << trial;
  }
}

// Neither side is left without samples where both may contribute, however unequal they are; where only one
// does, it gets all.
TEST(LightChoice, NeitherNearbyLightsNorThoseAtInfinityStarve) {
  PunctualLightDescription sun, lamp;
  sun.kind = PunctualLightDescription::Kind::directional;
  sun.to_world.z = {0, 1, 0};
  sun.to_world.y = {0, 0, -1};
  lamp.to_world.origin = {0, 2, 0};
  for (const float ratio : {1e-9f, 1e-5f, 1.f, 1e5f, 1e9f}) {
    sun.intensity = ratio;
    const Scene scene = SceneBuilder()
                            .add(parallelogram({-200, 0, -200}, {0, 0, 400}, {400, 0, 0}), diffuse(0.5f))
                            .add(lamp)
                            .add(sun)
                            .build();
    const LightSet& lights = scene.lights();
    for (const float x : {0.f, 3.f, 150.f}) {
      const LightReceiver floor{{x, 0, 0}, {0, 1, 0}};
      EXPECT_GE(lights.prob(floor, 0), 0.1f) << ratio << " at " << x;
      EXPECT_GE(lights.prob(floor, 1), 0.1f) << ratio << " at " << x;
      EXPECT_NEAR(lights.prob(floor, 0) + lights.prob(floor, 1), 1, 1e-6);
    }
    EXPECT_EQ(lights.prob({{0, 5, 0}, {0, 1, 0}}, 0), 0);
    EXPECT_EQ(lights.prob({{0, 5, 0}, {0, 1, 0}}, 1), 1);
  }
}

}  // namespace
}  // namespace vernier::test
